#include "server/result_sender.h"

#include "holdfast/v1/denoise_service.pb.h"
#include "proto/wire_profile.h"
#include "server/convert.h"

namespace holdfast::server {

bool ResultSender::next(wire::OutgoingMessage& message) {
  const bool has_planes = !slot_.error && !slot_.answer->dropped;
  if (!begun_) {
    begun_ = true;
    const wire::WireProfile& profile = *wire::find_profile(config_.wire);
    if (has_planes)
      for (const PlaneId id : config_.results)
        codings_.push_back(wire::fitting_coding(slot_.answer->results.at(id), profile.result));
    v1::DenoiseResponse response;
    write_frame_result(slot_, config_, codings_, *response.mutable_frame_result());
    wire::write_message(response, message.bytes);
    message.plane_bytes = message.shared_bytes = 0;
    return true;
  }
  if (!has_planes || plane_ == config_.results.size()) return false;

  const Plane& plane = slot_.answer->results.at(config_.results[plane_]);
  offset_ = chunks_.write(plane, codings_[plane_], static_cast<std::uint32_t>(plane_), offset_,
                          slot_.answer, message);
  if (offset_ == 0) ++plane_;
  return true;
}

}  // namespace holdfast::server
