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
  std::size_t max_session_bytes = std::size_t{8} << 30;  ///< frames in flight, history
  std::size_t max_total_bytes = std::size_t{16} << 30;   ///< of all sessions, scratch included
  int max_dimension = kMaxDimension;                     ///< pixels, width and height of a frame
  std::chrono::milliseconds linger{30000};  ///< a session without a stream is kept this long
  int credits = 3;                          ///< frames in flight for each session, >= 1
  double max_frames_per_second = 0;         ///< of each session; 0 = no limit
  std::size_t max_bytes_per_second = 0;     ///< that each session may send; 0 = no limit
  std::size_t max_sessions_per_token = 0;   ///< made with the same bearer token; 0 = no limit
  /// Share of the time of the threads that filter, which sessions that tell their rate may take
  /// together, 0..1; 0 = no limit.
  double max_load = 0.75;
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
  std::string shared_memory;       ///< path of the side socket for shared memory; empty = none
  std::string admin;               ///< host:port of the admin port; empty = none
  bool admin_previews = false;     ///< the admin port shows pictures of sessions
  bool allow_remote = false;       ///< addresses beyond this machine may be listened on
  int threads = 0;                 ///< threads that filter; 0 = one for each core
  std::string log_level = "info";  ///< trace, debug, info, warn, error, off
  std::chrono::milliseconds drain_deadline{10000};    ///< for frames in flight at shutdown
  std::chrono::milliseconds keepalive{10000};         ///< a silent peer is asked after this
  std::chrono::milliseconds keepalive_timeout{5000};  ///< and lost if it does not answer in this
  std::size_t max_streams = 256;                      ///< open streams, of all clients
  std::size_t max_waiting_per_address = 64;           ///< of these, without Hello; 0 = no limit
  std::chrono::milliseconds hello_timeout{10000};     ///< for Hello in a new stream; 0 = none
  std::chrono::milliseconds frame_timeout{30000};     ///< from FrameBegin to FrameEnd; 0 = none
  TlsConfig tls;
  std::string token_file;  ///< bearer tokens of clients, one a line; empty = none asked for
  SessionLimits limits;
  /// Measure the presets at start; else when the first session with a budget is made.
  bool calibrate = false;
};

/// Throws InputError naming the first value that breaks a rule. Opens no port.
void check_config(const ServerConfig& config);

}  // namespace holdfast::server
