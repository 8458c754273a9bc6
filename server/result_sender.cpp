#include "server/result_sender.h"

#include <algorithm>

#include "proto/plane_bytes.h"
#include "server/convert.h"

namespace holdfast::server {

bool ResultSender::next(v1::DenoiseResponse& response) {
  if (!begun_) {
    begun_ = true;
    response.Clear();
    write_frame_result(slot_, config_, *response.mutable_frame_result());
    return true;
  }
  if (slot_.error || slot_.answer->dropped || plane_ == config_.results.size()) return false;

  const Plane& plane = slot_.answer->results.at(config_.results[plane_]);
  const std::size_t size = wire::plane_bytes(plane);
  const std::size_t bytes = std::min(wire::kMaxChunkBytes, size - offset_);
  v1::PlaneChunk& chunk = *response.mutable_plane_chunk();  // keeps the buffer of the chunk before
  chunk.set_plane(static_cast<std::uint32_t>(plane_));
  chunk.set_offset(offset_);
  chunk.mutable_data()->resize(bytes);
  wire::read_plane_bytes(plane, offset_, bytes, chunk.mutable_data()->data());
  offset_ += bytes;
  chunk.set_last(offset_ == size);
  if (chunk.last()) {
    offset_ = 0;
    ++plane_;
  }
  return true;
}

}  // namespace holdfast::server
