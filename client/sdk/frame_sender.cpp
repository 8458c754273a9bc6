#include "client/sdk/frame_sender.h"

#include <algorithm>

#include "client/sdk/convert.h"
#include "proto/plane_bytes.h"

namespace holdfast::client {

bool FrameSender::next(v1::DenoiseRequest& request) {
  if (ended_) return false;
  if (!begun_) {
    begun_ = true;
    request.Clear();
    write_frame_begin(out_, planes_, *request.mutable_frame_begin());
    return true;
  }
  if (plane_ == planes_.size()) {
    ended_ = true;
    request.mutable_frame_end()->set_index(out_.frame->index);
    return true;
  }
  const Plane& plane = out_.frame->planes.at(planes_[plane_]);
  const std::size_t size = wire::plane_bytes(plane);
  const std::size_t bytes = std::min(wire::kMaxChunkBytes, size - offset_);
  v1::PlaneChunk& chunk = *request.mutable_plane_chunk();  // keeps the buffer of the chunk before
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

}  // namespace holdfast::client
