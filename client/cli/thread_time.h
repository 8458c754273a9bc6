#pragma once

#include <ctime>

namespace holdfast::cli {

/// Processor time of this thread, ms.
inline double thread_ms() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

}  // namespace holdfast::cli
