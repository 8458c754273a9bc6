#pragma once

#include <memory>
#include <string>

namespace holdfast::server {

/// A server in this process, reached through gRPC over a unix socket in a private directory, or
/// over the loopback address; with kSharedMemory as with kUnix, and it offers that besides. The
/// only header of the server that a client program may include.
class EmbeddedServer {
 public:
  enum class Link { kUnix, kTcp, kSharedMemory };

  /// `threads` that filter, 0 = one for each core. `log_level` as in ServerConfig.
  explicit EmbeddedServer(int threads = 0, const std::string& log_level = "warn",
                          Link link = Link::kUnix);
  /// Stops the server and removes the socket.
  ~EmbeddedServer();

  const std::string& address() const;
  /// Path of the side socket for shared memory; empty if there is none.
  const std::string& shared_memory() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace holdfast::server
