#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>

#include "proto/chunk_message.h"
#include "proto/shared_memory.h"

namespace holdfast::wire {

/// The cells of one direction as the end sees them that writes. One thread writes at a time; others
/// may note what was read.
class CellWriter {
 public:
  CellWriter(std::shared_ptr<SharedMemory> memory, SharedPart part)
      : memory_(std::move(memory)), part_(part) {}

  /// True if the other end has not told that it has read the next cell.
  bool full() const { return written_ - read_ >= memory_->layout().cells; }
  /// True if the other end has told that it has read all that was written.
  bool all_read() const { return written_ == read_; }
  /// The next cell, of at least kMaxChunkBytes; not if `full`.
  std::byte* cell() const { return memory_->cell(part_, written_); }
  /// The next cell is the one after.
  void advance() { ++written_; }
  /// The other end has read `cells` since the beginning. Throws InputError if that is less than
  /// before, or more than was written.
  void note_read(std::uint64_t cells);

 private:
  const std::shared_ptr<SharedMemory> memory_;
  const SharedPart part_;
  std::atomic<std::uint64_t> written_ = 0, read_ = 0;
};

/// The same as the end sees them that reads. One thread at a time.
class CellReader {
 public:
  CellReader(std::shared_ptr<SharedMemory> memory, SharedPart part)
      : memory_(std::move(memory)), part_(part) {}

  /// The first `bytes` of the next cell; the next one is then that after it. Throws InputError if a
  /// cell has not so many.
  std::string_view take(std::uint64_t bytes);
  /// What the other end has to be told now: the cells that were read since the beginning. To be
  /// called when what `take` gave has been copied.
  std::optional<std::uint64_t> due();

 private:
  const std::shared_ptr<SharedMemory> memory_;
  const SharedPart part_;
  std::uint64_t taken_ = 0, told_ = 0;
};

/// Both directions of one stream, for the server or for the client.
struct SharedCells {
  SharedCells(const std::shared_ptr<SharedMemory>& shared, SharedPart written)
      : memory(shared),
        writer(memory, written),
        reader(memory, written == SharedPart::kInput ? SharedPart::kResults : SharedPart::kInput) {}
  const std::shared_ptr<SharedMemory> memory;
  CellWriter writer;
  CellReader reader;
};

/// Lets a chunk whose bytes lie in shared memory refer to them. `cells`: null if the stream has
/// none. Throws InputError if the chunk breaks a rule; its cell, if there is one, is then taken all
/// the same, as the other end counts.
void find_shared(ChunkView& chunk, CellReader* cells);

}  // namespace holdfast::wire
