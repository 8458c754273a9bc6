#pragma once

#include <malloc.h>

namespace holdfast::wire {

/// Has the allocator keep what gRPC frees after each message that it received, up to 16 MiB of an
/// arena, instead of giving it back to the kernel and touching it anew for the next one. For the
/// main function of a program, before it has threads: it holds for all of the process.
inline void keep_receive_memory() {
  constexpr int kLargestReadBytes = 4 << 20;  // of gRPC's reads of a socket, with room for a header
  mallopt(M_MMAP_THRESHOLD, kLargestReadBytes + (64 << 10));
  mallopt(M_TRIM_THRESHOLD, 16 << 20);
}

}  // namespace holdfast::wire
