#include "proto/chunk_writer.h"

#include <algorithm>
#include <cstring>
#include <mutex>

namespace holdfast::wire {

/// Memory for pieces.
class ChunkWriter::Buffers {
 public:
  std::unique_ptr<std::string> take() {
    const std::lock_guard lock(mutex_);
    if (spare_.empty()) return std::make_unique<std::string>();
    auto buffer = std::move(spare_.back());
    spare_.pop_back();
    return buffer;
  }
  void give(std::unique_ptr<std::string> buffer) {
    const std::lock_guard lock(mutex_);
    if (spare_.size() < kKept) spare_.push_back(std::move(buffer));
  }

 private:
  std::mutex mutex_;
  std::vector<std::unique_ptr<std::string>> spare_;
};

namespace {

// Shorter rows are copied. A slice for each costs less CPU than a copy from here on (a tenth of the
// transport's); with rows of half that length both cost the same.
constexpr std::size_t kLeastRowBytes = 4096;

using Owner = std::shared_ptr<const void>;

/// A slice over memory of `owner`.
grpc::Slice slice_of(const std::byte* data, std::size_t bytes, const Owner& owner) {
  // gRPC reads it only.
  return grpc::Slice(
      const_cast<std::byte*>(data), bytes, [](void* held) { delete static_cast<Owner*>(held); },
      new Owner(owner));
}

bool lies_as_on_the_wire(const Plane& plane, PlaneCoding coding) {
  return coding == full_coding(plane.id().kind) && is_packed(plane);
}

std::size_t row_bytes(const Plane& plane) {
  return static_cast<std::size_t>(plane.width()) * sizeof(std::uint32_t);
}

/// True if the rows of the plane lie in memory as on the wire, and are long enough to be slices.
bool lies_in_rows(const Plane& plane, PlaneCoding coding) {
  return coding == full_coding(plane.id().kind) &&
         (row_bytes(plane) >= kLeastRowBytes || is_packed(plane));
}

/// Slices over `bytes` bytes at `offset` of a plane that lies in rows: one for each row, or one for
/// all if there is no padding.
void refer(const Plane& plane, std::size_t offset, std::size_t bytes, const Owner& owner,
           std::vector<grpc::Slice>& out) {
  const auto first = plane.words(0);
  const std::size_t row = row_bytes(plane);
  const std::size_t padding = static_cast<std::size_t>(first.stride) * sizeof(std::uint32_t) - row;
  const auto in_memory = [&](std::size_t at) { return at + at / row * padding; };
  const std::size_t begin = in_memory(offset), end = in_memory(offset + bytes - 1) + 1;
  const auto* const base = reinterpret_cast<const std::byte*>(first.data);
  const grpc::Slice all = slice_of(base + begin, end - begin, owner);
  if (padding == 0) return out.push_back(all);
  for (std::size_t at = offset, left = bytes; left > 0;) {
    const std::size_t here = std::min(row - at % row, left);
    const std::size_t from = in_memory(at) - begin;
    out.push_back(all.sub(from, from + here));
    at += here;
    left -= here;
  }
}

}  // namespace

ChunkWriter::ChunkWriter() : buffers_(std::make_shared<Buffers>()) {}

std::size_t ChunkWriter::write(const Plane& plane, PlaneCoding coding, std::uint32_t number,
                               std::size_t offset, const Owner& owner, OutgoingMessage& message) {
  ChunkFields fields;
  fields.plane = number;
  fields.offset = offset;
  std::size_t bytes = 0;
  data_.clear();
  message.shared_bytes = 0;
  if (cells_ != nullptr && !cells_->full())
    message.shared_bytes = in_cell(plane, coding, offset, bytes);
  else
    in_stream(plane, coding, offset, owner, bytes);
  fields.shared_bytes = static_cast<std::uint32_t>(message.shared_bytes);
  fields.last = offset + bytes == plane_bytes(plane, coding.format);
  if (coding.codec != Codec::kNone) fields.plain_bytes = static_cast<std::uint32_t>(bytes);
  message.bytes = chunk_message(fields, data_);
  message.plane_bytes = message.shared_bytes;
  for (const grpc::Slice& piece : data_) message.plane_bytes += piece.size();
  data_.clear();  // lets go of the owner
  return fields.last ? 0 : offset + bytes;
}

/// The piece as it goes into a message, to data_; `bytes`: what it holds of the plane.
void ChunkWriter::in_stream(const Plane& plane, PlaneCoding coding, std::size_t offset,
                            const Owner& owner, std::size_t& bytes) {
  if (lies_in_rows(plane, coding)) {
    bytes = std::min(kMaxChunkBytes, plane_bytes(plane, coding.format) - offset);
    return refer(plane, offset, bytes, owner, data_);
  }
  std::shared_ptr<std::string> buffer(
      buffers_->take().release(),
      [pool = buffers_](std::string* used) { pool->give(std::unique_ptr<std::string>(used)); });
  bytes = coder_.encode(plane, coding, offset, *buffer);
  const auto* const made = reinterpret_cast<const std::byte*>(buffer->data());
  const std::size_t made_bytes = buffer->size();
  data_.push_back(slice_of(made, made_bytes, std::move(buffer)));
}

/// The same in the next cell; the bytes of the piece there.
std::size_t ChunkWriter::in_cell(const Plane& plane, PlaneCoding coding, std::size_t offset,
                                 std::size_t& bytes) {
  std::size_t size = 0;
  if (lies_as_on_the_wire(plane, coding)) {
    size = bytes = std::min(kMaxChunkBytes, plane_bytes(plane, coding.format) - offset);
    std::memcpy(cells_->cell(), reinterpret_cast<const std::byte*>(plane.words(0).data) + offset,
                size);
  } else {
    bytes = coder_.encode_shared(plane, coding, offset, cells_->cell(), size);
  }
  cells_->advance();
  return size;
}

}  // namespace holdfast::wire
