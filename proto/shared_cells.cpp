#include "proto/shared_cells.h"

#include <string>

#include "core/frame/error.h"

namespace holdfast::wire {

void CellWriter::note_read(std::uint64_t cells) {
  if (cells < read_ || cells > written_)
    throw InputError("cells of SharedRead",
                     "must be in " + std::to_string(read_) + ".." + std::to_string(written_),
                     std::to_string(cells));
  read_ = cells;
}

std::string_view CellReader::take(std::uint64_t bytes) {
  const std::byte* const cell = memory_->cell(part_, taken_++);
  const std::size_t most = memory_->layout().cell_bytes;
  if (bytes > most)
    throw InputError("shared_bytes of a chunk", "must be at most " + std::to_string(most),
                     std::to_string(bytes));
  return {reinterpret_cast<const char*>(cell), static_cast<std::size_t>(bytes)};
}

std::optional<std::uint64_t> CellReader::due() {
  if (2 * (taken_ - told_) < memory_->layout().cells) return {};
  return told_ = taken_;
}

void find_shared(ChunkView& chunk, CellReader* cells) {
  const std::uint32_t bytes = chunk.fields.shared_bytes;
  if (bytes == 0) return;
  if (cells == nullptr)
    throw InputError("shared_bytes of a chunk", "must be 0 in a stream without shared memory",
                     std::to_string(bytes));
  const std::string_view found = cells->take(bytes);
  if (chunk.data_bytes != 0)
    throw InputError("data of a chunk in shared memory", "must be empty",
                     std::to_string(chunk.data_bytes) + " bytes");
  chunk.data.assign(1, found);
  chunk.data_bytes = found.size();
  chunk.shared = true;
}

}  // namespace holdfast::wire
