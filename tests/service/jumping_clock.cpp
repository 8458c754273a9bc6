// Preloaded into a server: its wall clock is a day ahead for as long as the file exists that
// HOLDFAST_CLOCK_JUMP names. Clocks that only go forward are as they are.
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

#include <cstdlib>

extern "C" int clock_gettime(clockid_t clock, timespec* time) noexcept {
  const long result = syscall(SYS_clock_gettime, clock, time);
  static const char* const file = std::getenv("HOLDFAST_CLOCK_JUMP");
  if (clock == CLOCK_REALTIME && file != nullptr && access(file, F_OK) == 0)
    time->tv_sec += 24 * 3600;
  return static_cast<int>(result);
}
