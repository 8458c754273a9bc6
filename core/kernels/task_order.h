#pragma once

#if defined(__SANITIZE_THREAD__)
extern "C" void __tsan_acquire(void* address);
extern "C" void __tsan_release(void* address);
#endif

namespace holdfast {

/// Tells ThreadSanitizer in what order a parallel loop runs: its tasks after what its caller did
/// before, and what the caller does next after them. oneTBB keeps that order, but Debian builds it
/// without the sanitizer, which would take every row for a race. Tasks stay unordered among
/// themselves. Without the sanitizer it does nothing.
class TaskOrder {
 public:
#if defined(__SANITIZE_THREAD__)
  void begin_loop() noexcept { __tsan_release(&begin_); }
  void begin_task() noexcept { __tsan_acquire(&begin_); }
  void end_task() noexcept { __tsan_release(&end_); }
  void end_loop() noexcept { __tsan_acquire(&end_); }

 private:
  char begin_ = 0, end_ = 0;
#else
  void begin_loop() noexcept {}
  void begin_task() noexcept {}
  void end_task() noexcept {}
  void end_loop() noexcept {}
#endif
};

}  // namespace holdfast
