#pragma once

#include <sys/types.h>

#include <cstddef>
#include <string>

#include "client/cli/embedded_server.h"

namespace holdfast::cli {

/// An embedded server in a process of its own, so that its time and memory can be told from a
/// client's. To be made before this program has threads or has used gRPC. The process ends with
/// the object, or with this program.
class ServerChild {
 public:
  /// Throws std::runtime_error.
  explicit ServerChild(EmbeddedServer::Link link);
  ~ServerChild();
  ServerChild(const ServerChild&) = delete;
  ServerChild& operator=(const ServerChild&) = delete;

  const std::string& address() const { return address_; }
  /// Where to ask for shared memory; empty if there is none.
  const std::string& shared_memory() const { return shared_memory_; }
  /// CPU time so far, seconds.
  double cpu_seconds() const;
  /// Resident memory now, and the most there ever was, bytes.
  std::size_t resident_bytes() const;
  std::size_t peak_bytes() const;

 private:
  std::size_t status_bytes(const char* key) const;

  pid_t pid_ = -1;
  int stop_ = -1;  ///< closed to end the process
  std::string address_, shared_memory_;
};

}  // namespace holdfast::cli
