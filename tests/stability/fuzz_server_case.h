#pragma once

#include <memory>

#include "tests/stability/fuzz_damage.h"

namespace holdfast::test {

/// A server at a unix socket, hostile streams of bytes to it, and a healthy session beside them.
class ServerFuzz {
 public:
  ServerFuzz();
  ~ServerFuzz();

  /// A session whose stream sends damaged messages and ends in some way; a second stream of it with
  /// a whole frame; then a frame of the healthy session. A problem is a stream that does not end
  /// within 20 s or ends with a failure of the server, an answer that says so or cannot be read, a
  /// whole frame that is refused, and a healthy answer that is not, bit for bit, that of the core.
  ReadOutcome run(std::uint32_t seed);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace holdfast::test
