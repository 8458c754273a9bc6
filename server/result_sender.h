#pragma once

#include <cstddef>
#include <vector>

#include "holdfast/v1/denoise_service.pb.h"
#include "proto/plane_coder.h"
#include "server/frame_slot.h"
#include "server/session.h"

namespace holdfast::server {

/// Turns one answered frame into messages: FrameResult, then the chunks of each result plane.
class ResultSender {
 public:
  /// `coder`: its memory is used.
  ResultSender(const FrameSlot& slot, const SessionConfig& config, wire::PlaneCoder& coder)
      : slot_(slot), config_(config), coder_(coder) {}

  /// Writes the next message to `response`; false if there is none left.
  bool next(v1::DenoiseResponse& response);

 private:
  const FrameSlot& slot_;
  const SessionConfig& config_;
  wire::PlaneCoder& coder_;
  std::vector<wire::PlaneCoding> codings_;  ///< of the session's results, if they are sent
  bool begun_ = false;
  std::size_t plane_ = 0, offset_ = 0;
};

}  // namespace holdfast::server
