#include "proto/chunk_writer.h"

#include <algorithm>
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

}  // namespace

ChunkWriter::ChunkWriter() : buffers_(std::make_shared<Buffers>()) {}

std::size_t ChunkWriter::write(const Plane& plane, PlaneCoding coding, std::uint32_t number,
                               std::size_t offset, const Owner& owner, OutgoingMessage& message) {
  const std::size_t size = plane_bytes(plane, coding.format);
  ChunkFields fields;
  fields.plane = number;
  fields.offset = offset;
  std::size_t bytes = 0;
  grpc::Slice data;
  if (lies_as_on_the_wire(plane, coding)) {
    bytes = std::min(kMaxChunkBytes, size - offset);
    data = slice_of(reinterpret_cast<const std::byte*>(plane.words(0).data) + offset, bytes, owner);
  } else {
    std::shared_ptr<std::string> buffer(
        buffers_->take().release(),
        [pool = buffers_](std::string* used) { pool->give(std::unique_ptr<std::string>(used)); });
    bytes = coder_.encode(plane, coding, offset, *buffer);
    const auto* const made = reinterpret_cast<const std::byte*>(buffer->data());
    const std::size_t made_bytes = buffer->size();
    data = slice_of(made, made_bytes, std::move(buffer));
  }
  fields.last = offset + bytes == size;
  if (coding.codec != Codec::kNone) fields.plain_bytes = static_cast<std::uint32_t>(bytes);
  message.bytes = chunk_message(fields, data);
  message.plane_bytes = data.size();
  return fields.last ? 0 : offset + bytes;
}

}  // namespace holdfast::wire
