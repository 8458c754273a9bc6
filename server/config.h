#pragma once

#include <chrono>
#include <cstddef>
#include <string>

namespace holdfast::server {

/// Largest number of lights in a session.
inline constexpr int kMaxLights = 256;

/// What the sessions of a server may take together and alone.
struct SessionLimits {
  std::size_t max_sessions = 64;
  std::size_t max_session_bytes = std::size_t{8} << 30;  ///< frames in flight, history and scratch
  std::size_t max_total_bytes = std::size_t{16} << 30;   ///< the same, of all sessions
  std::chrono::milliseconds linger{30000};  ///< a session without a stream is kept this long
  int credits = 3;                          ///< frames in flight for each session, >= 1
};

/// The whole configuration of a server. Every value has a default that works.
struct ServerConfig {
  std::string listen = "127.0.0.1:50051";  ///< host:port (port 0 = any free one) or unix:PATH
  int threads = 0;                         ///< threads that filter; 0 = one for each core
  std::string log_level = "info";          ///< trace, debug, info, warn, error, off
  std::chrono::milliseconds drain_deadline{10000};  ///< for frames in flight at shutdown
  SessionLimits limits;
};

}  // namespace holdfast::server
