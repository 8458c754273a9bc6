#pragma once

#include <memory>
#include <string>

namespace holdfast::cli {

/// A Holdfast server inside this program, for use without an installed one. Clients reach it at
/// `address` through gRPC as they reach any other.
class EmbeddedServer {
 public:
  enum class Link { kUnix, kTcp, kSharedMemory };

  /// `threads` that filter; 0 = one for each core. Over a unix socket, or over the loopback
  /// address; kSharedMemory: over a unix socket, with shared memory for those who ask for it.
  explicit EmbeddedServer(int threads, Link link = Link::kUnix);
  ~EmbeddedServer();
  const std::string& address() const;
  /// Where to ask for shared memory; empty if there is none.
  const std::string& shared_memory() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace holdfast::cli
