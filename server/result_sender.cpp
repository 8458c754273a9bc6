#include "server/result_sender.h"

#include "proto/wire_profile.h"
#include "server/convert.h"

namespace holdfast::server {

bool ResultSender::next(v1::DenoiseResponse& response) {
  const bool has_planes = !slot_.error && !slot_.answer->dropped;
  if (!begun_) {
    begun_ = true;
    const wire::WireProfile& profile = *wire::find_profile(config_.wire);
    if (has_planes)
      for (const PlaneId id : config_.results)
        codings_.push_back(wire::fitting_coding(slot_.answer->results.at(id), profile.result));
    response.Clear();
    write_frame_result(slot_, config_, codings_, *response.mutable_frame_result());
    return true;
  }
  if (!has_planes || plane_ == config_.results.size()) return false;

  const Plane& plane = slot_.answer->results.at(config_.results[plane_]);
  const wire::PlaneCoding coding = codings_[plane_];
  v1::PlaneChunk& chunk = *response.mutable_plane_chunk();  // keeps the buffer of the chunk before
  chunk.set_plane(static_cast<std::uint32_t>(plane_));
  chunk.set_offset(offset_);
  const std::size_t bytes = coder_.encode(plane, coding, offset_, *chunk.mutable_data());
  chunk.set_plain_bytes(coding.codec == wire::Codec::kNone ? 0 : static_cast<std::uint32_t>(bytes));
  offset_ += bytes;
  chunk.set_last(offset_ == wire::plane_bytes(plane, coding.format));
  if (chunk.last()) {
    offset_ = 0;
    ++plane_;
  }
  return true;
}

}  // namespace holdfast::server
