#pragma once

#include <cstddef>

#include "holdfast/v1/denoise_service.pb.h"
#include "server/frame_slot.h"
#include "server/session.h"

namespace holdfast::server {

/// Turns one answered frame into messages: FrameResult, then the chunks of each result plane.
class ResultSender {
 public:
  ResultSender(const FrameSlot& slot, const SessionConfig& config) : slot_(slot), config_(config) {}

  /// Writes the next message to `response`; false if there is none left.
  bool next(v1::DenoiseResponse& response);

 private:
  const FrameSlot& slot_;
  const SessionConfig& config_;
  bool begun_ = false;
  std::size_t plane_ = 0, offset_ = 0;
};

}  // namespace holdfast::server
