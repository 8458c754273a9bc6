#pragma once

#include <cstddef>

namespace holdfast::test {

/// Watches the heap of a program, of all threads and libraries, by functions that take the place of
/// malloc and its like. Counts nothing where a sanitizer has taken it already.
class PeakMemory {
 public:
  /// Counts from now on. A request that would take more than `limit` bytes beyond what is in use
  /// now fails, as on a machine without more, and counts as granted.
  explicit PeakMemory(std::size_t limit);
  ~PeakMemory();
  PeakMemory(const PeakMemory&) = delete;
  PeakMemory& operator=(const PeakMemory&) = delete;

  /// Most bytes in use, or asked for, beyond what was in use at the start.
  std::size_t bytes() const;

 private:
  std::size_t start_;
};

}  // namespace holdfast::test
