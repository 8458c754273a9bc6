#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>

#include "proto/plane_bytes.h"

namespace holdfast::wire {

/// A file descriptor, closed at the end.
class Descriptor {
 public:
  explicit Descriptor(int fd = -1) : fd_(fd) {}
  ~Descriptor();
  Descriptor(Descriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
  }
  int get() const { return fd_; }
  explicit operator bool() const { return fd_ >= 0; }

 private:
  int fd_;
};

/// How shared memory is divided.
struct SharedLayout {
  std::size_t cells = 4;                    ///< of each direction
  std::size_t cell_bytes = kMaxChunkBytes;  ///< at least that, so that each piece has room
  std::size_t bytes() const { return 2 * cells * cell_bytes; }
};

/// Which cells: those that the client writes, or the server.
enum class SharedPart { kInput, kResults };

/// Memory that a server and a client of the same machine both map; see shared_memory.proto. The
/// other end may write to it at any time: whoever reads it copies first and judges the copy.
class SharedMemory {
 public:
  /// New memory, whose size is sealed. Throws std::system_error.
  static std::shared_ptr<SharedMemory> make(const SharedLayout& layout = {});
  /// That of somebody else. Throws std::runtime_error, and maps nothing, unless it is of the
  /// layout's size and sealed against shrinking, which would end us with SIGBUS.
  static std::shared_ptr<SharedMemory> map(int descriptor, const SharedLayout& layout);
  ~SharedMemory();
  SharedMemory(const SharedMemory&) = delete;
  SharedMemory& operator=(const SharedMemory&) = delete;

  const SharedLayout& layout() const { return layout_; }
  /// Where cell `count` modulo their number begins.
  std::byte* cell(SharedPart part, std::uint64_t count) const;
  /// Of memory that was made; -1 of mapped memory.
  int descriptor() const { return descriptor_.get(); }
  /// Gives the pages of a part back, whoever still maps it; it then reads as zeros. For the end
  /// that has made it.
  void discard(SharedPart part) const;

 private:
  SharedMemory(Descriptor descriptor, int mapped, const SharedLayout& layout);

  Descriptor descriptor_;
  const SharedLayout layout_;
  std::byte* data_ = nullptr;
};

}  // namespace holdfast::wire
