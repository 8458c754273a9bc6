#include "tests/stability/peak_memory.h"

#include <malloc.h>

#include <atomic>
#include <cerrno>
#include <cstdint>

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)

namespace holdfast::test {

PeakMemory::PeakMemory(std::size_t) : start_(0) {}
PeakMemory::~PeakMemory() = default;
std::size_t PeakMemory::bytes() const { return 0; }

}  // namespace holdfast::test

#else

// What glibc calls its own, and what takes the place of the rest, whose parameters it names as it
// may.
// NOLINTBEGIN(bugprone-reserved-identifier,readability-inconsistent-declaration-parameter-name)
extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
void __libc_free(void*);
}

namespace {

std::atomic<std::size_t> used{0}, peak{0}, most{SIZE_MAX};

bool allowed(std::size_t bytes) {
  const std::size_t now = used + bytes;
  std::size_t before = peak;
  while (before < now && !peak.compare_exchange_weak(before, now)) {
  }
  return bytes <= PTRDIFF_MAX && now <= most;
}

void* counted(void* pointer) {
  if (pointer != nullptr) used += malloc_usable_size(pointer);
  return pointer;
}

void* refused() {
  errno = ENOMEM;
  return nullptr;
}

}  // namespace

extern "C" {

void* malloc(std::size_t bytes) {
  return allowed(bytes) ? counted(__libc_malloc(bytes)) : refused();
}
void* calloc(std::size_t count, std::size_t bytes) {
  std::size_t all = 0;
  const bool fits = !__builtin_mul_overflow(count, bytes, &all);
  return fits && allowed(all) ? counted(__libc_calloc(count, bytes)) : refused();
}
void free(void* pointer) {
  if (pointer != nullptr) used -= malloc_usable_size(pointer);
  __libc_free(pointer);
}
void* realloc(void* pointer, std::size_t bytes) {
  const std::size_t before = pointer != nullptr ? malloc_usable_size(pointer) : 0;
  if (bytes > before && !allowed(bytes - before)) return refused();
  void* const moved = __libc_realloc(pointer, bytes);
  if (moved != nullptr || bytes == 0) used -= before;
  return counted(moved);
}
void* memalign(std::size_t alignment, std::size_t bytes) {
  return allowed(bytes) ? counted(__libc_memalign(alignment, bytes)) : refused();
}
void* aligned_alloc(std::size_t alignment, std::size_t bytes) { return memalign(alignment, bytes); }
int posix_memalign(void** out, std::size_t alignment, std::size_t bytes) {
  void* const pointer = memalign(alignment, bytes);
  if (pointer == nullptr) return ENOMEM;
  *out = pointer;
  return 0;
}

}  // extern "C"
// NOLINTEND(bugprone-reserved-identifier,readability-inconsistent-declaration-parameter-name)

namespace holdfast::test {

PeakMemory::PeakMemory(std::size_t limit) : start_(used) {
  peak = start_;
  most = start_ + limit;
}
PeakMemory::~PeakMemory() { most = SIZE_MAX; }
std::size_t PeakMemory::bytes() const { return peak - start_; }

}  // namespace holdfast::test

#endif
