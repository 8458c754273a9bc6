#include "proto/shared_memory.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <stdexcept>
#include <system_error>

namespace holdfast::wire {
namespace {

constexpr std::size_t kMostCells = 64;  // of each direction

[[noreturn]] void fail(const char* what) {
  throw std::system_error(errno, std::generic_category(), what);
}

}  // namespace

Descriptor::~Descriptor() {
  if (fd_ >= 0) close(fd_);
}

std::shared_ptr<SharedMemory> SharedMemory::make(const SharedLayout& layout) {
  Descriptor made(memfd_create("holdfast", MFD_CLOEXEC | MFD_ALLOW_SEALING));
  if (!made) fail("memfd_create");
  if (ftruncate(made.get(), static_cast<off_t>(layout.bytes())) != 0) fail("ftruncate");
  if (fcntl(made.get(), F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_SEAL) != 0)
    fail("F_ADD_SEALS");
  // Pages are made here, where a lack of them is an error, and not where they are written first.
  if (fallocate(made.get(), 0, 0, static_cast<off_t>(layout.bytes())) != 0) fail("fallocate");
  const int mapped = made.get();
  return std::shared_ptr<SharedMemory>(new SharedMemory(std::move(made), mapped, layout));
}

std::shared_ptr<SharedMemory> SharedMemory::map(int descriptor, const SharedLayout& layout) {
  if (layout.cells < 1 || layout.cells > kMostCells || layout.cell_bytes < kMaxChunkBytes ||
      layout.cell_bytes > std::size_t{kMaxMessageBytes})
    throw std::runtime_error("shared memory of an unknown layout");
  struct stat status {};
  const int seals = fcntl(descriptor, F_GET_SEALS);
  if (seals < 0 || (seals & F_SEAL_SHRINK) == 0)
    throw std::runtime_error("shared memory that may shrink");
  if (fstat(descriptor, &status) != 0 || status.st_size != static_cast<off_t>(layout.bytes()))
    throw std::runtime_error("shared memory of another size than told");
  return std::shared_ptr<SharedMemory>(new SharedMemory(Descriptor(), descriptor, layout));
}

SharedMemory::SharedMemory(Descriptor descriptor, int mapped, const SharedLayout& layout)
    : descriptor_(std::move(descriptor)), layout_(layout) {
  void* const data =
      mmap(nullptr, layout.bytes(), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_POPULATE, mapped, 0);
  if (data == MAP_FAILED) fail("mmap");
  data_ = static_cast<std::byte*>(data);
}

SharedMemory::~SharedMemory() { munmap(data_, layout_.bytes()); }

void SharedMemory::discard(SharedPart part) const {
  const auto bytes = static_cast<off_t>(layout_.cells * layout_.cell_bytes);
  // Failure costs memory until the other end lets go.
  fallocate(descriptor(), FALLOC_FL_PUNCH_HOLE | FALLOC_FL_KEEP_SIZE,
            part == SharedPart::kInput ? 0 : bytes, bytes);
}

std::byte* SharedMemory::cell(SharedPart part, std::uint64_t count) const {
  const std::size_t first = part == SharedPart::kInput ? 0 : layout_.cells;
  return data_ + (first + count % layout_.cells) * layout_.cell_bytes;
}

}  // namespace holdfast::wire
