#include "client/sdk/frame_sender.h"

#include "client/sdk/convert.h"

namespace holdfast::client {

bool FrameSender::next(wire::OutgoingMessage& message) {
  if (ended_) return false;
  if (begun_ && plane_ < planes_.size()) {
    const Plane& plane = out_.frame->planes.at(planes_[plane_]);
    offset_ = writer_.chunks.write(plane, codings_[plane_], static_cast<std::uint32_t>(plane_),
                                   offset_, out_.frame, message);
    if (offset_ == 0) ++plane_;
    return true;
  }
  v1::DenoiseRequest request;
  if (begun_) {
    ended_ = true;
    request.mutable_frame_end()->set_index(out_.frame->index);
  } else {
    begun_ = true;
    for (const PlaneId id : planes_)
      codings_.push_back(wire::fitting_coding(out_.frame->planes.at(id), writer_.profile->input));
    write_frame_begin(out_, planes_, codings_, *request.mutable_frame_begin());
  }
  wire::write_message(request, message.bytes);
  message.plane_bytes = message.shared_bytes = 0;
  return true;
}

}  // namespace holdfast::client
