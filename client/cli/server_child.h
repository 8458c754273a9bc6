#pragma once

#include <sys/types.h>

#include <cstddef>
#include <string>

namespace holdfast::cli {

/// An embedded server in a process of its own, so that its time and memory can be told from a
/// client's. To be made before this program has threads or has used gRPC. The process ends with
/// the object, or with this program.
class ServerChild {
 public:
  /// `tcp`: over the loopback address, else over a unix socket. Throws std::runtime_error.
  explicit ServerChild(bool tcp);
  ~ServerChild();
  ServerChild(const ServerChild&) = delete;
  ServerChild& operator=(const ServerChild&) = delete;

  const std::string& address() const { return address_; }
  /// CPU time so far, seconds.
  double cpu_seconds() const;
  /// Resident memory now, and the most there ever was, bytes.
  std::size_t resident_bytes() const;
  std::size_t peak_bytes() const;

 private:
  std::size_t status_bytes(const char* key) const;

  pid_t pid_ = -1;
  int stop_ = -1;  ///< closed to end the process
  std::string address_;
};

}  // namespace holdfast::cli
