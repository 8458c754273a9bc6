#pragma once

#include <memory>
#include <string>

namespace holdfast::cli {

/// A Holdfast server inside this program, for use without an installed one. Clients reach it at
/// `address` through gRPC as they reach any other.
class EmbeddedServer {
 public:
  /// `threads` that filter; 0 = one for each core.
  explicit EmbeddedServer(int threads);
  ~EmbeddedServer();
  const std::string& address() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace holdfast::cli
