#include "client/sdk/frame_sender.h"

#include "client/sdk/convert.h"

namespace holdfast::client {

bool FrameSender::next(v1::DenoiseRequest& request) {
  if (ended_) return false;
  if (!begun_) {
    begun_ = true;
    for (const PlaneId id : planes_)
      codings_.push_back(wire::fitting_coding(out_.frame->planes.at(id), writer_.profile->input));
    request.Clear();
    write_frame_begin(out_, planes_, codings_, *request.mutable_frame_begin());
    return true;
  }
  if (plane_ == planes_.size()) {
    ended_ = true;
    request.mutable_frame_end()->set_index(out_.frame->index);
    return true;
  }
  const Plane& plane = out_.frame->planes.at(planes_[plane_]);
  const wire::PlaneCoding coding = codings_[plane_];
  v1::PlaneChunk& chunk = *request.mutable_plane_chunk();  // keeps the buffer of the chunk before
  chunk.set_plane(static_cast<std::uint32_t>(plane_));
  chunk.set_offset(offset_);
  const std::size_t bytes = writer_.coder.encode(plane, coding, offset_, *chunk.mutable_data());
  chunk.set_plain_bytes(coding.codec == wire::Codec::kNone ? 0 : static_cast<std::uint32_t>(bytes));
  offset_ += bytes;
  chunk.set_last(offset_ == wire::plane_bytes(plane, coding.format));
  if (chunk.last()) {
    offset_ = 0;
    ++plane_;
  }
  return true;
}

}  // namespace holdfast::client
