#pragma once

#include <chrono>
#include <cstddef>
#include <string>

#include "core/frame/plane.h"

namespace holdfast::server {

/// Largest number of lights in a session.
inline constexpr int kMaxLights = 256;

/// What the sessions of a server may take together and alone.
struct SessionLimits {
  std::size_t max_sessions = 64;
  std::size_t max_session_bytes = std::size_t{8} << 30;  ///< frames in flight, history and scratch
  std::size_t max_total_bytes = std::size_t{16} << 30;   ///< the same, of all sessions
  int max_dimension = kMaxDimension;                     ///< pixels, width and height of a frame
  std::chrono::milliseconds linger{30000};  ///< a session without a stream is kept this long
  int credits = 3;                          ///< frames in flight for each session, >= 1
};

/// Encryption of the service; off unless `certificate` is set. All are files in PEM form, read
/// again when they change.
struct TlsConfig {
  std::string certificate;  ///< chain of the server
  std::string key;          ///< its private key
  std::string client_ca;    ///< if set, clients must show a certificate of these authorities
};

/// The whole configuration of a server. Every value has a default that works.
struct ServerConfig {
  std::string listen = "127.0.0.1:50051";  ///< host:port (port 0 = any free one) or unix:PATH
  std::string admin;                       ///< host:port of the admin port; empty = none
  bool allow_remote = false;               ///< addresses beyond this machine may be listened on
  int threads = 0;                         ///< threads that filter; 0 = one for each core
  std::string log_level = "info";          ///< trace, debug, info, warn, error, off
  std::chrono::milliseconds drain_deadline{10000};    ///< for frames in flight at shutdown
  std::chrono::milliseconds keepalive{10000};         ///< a silent peer is asked after this
  std::chrono::milliseconds keepalive_timeout{5000};  ///< and lost if it does not answer in this
  std::size_t max_streams = 256;                      ///< open streams, of all clients
  TlsConfig tls;
  std::string token_file;  ///< bearer tokens of clients, one a line; empty = none asked for
  SessionLimits limits;
  /// Measure the presets at start; else when the first session with a budget is made.
  bool calibrate = false;
};

/// Throws InputError naming the first value that breaks a rule. Opens no port.
void check_config(const ServerConfig& config);

}  // namespace holdfast::server
