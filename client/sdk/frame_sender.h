#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "client/sdk/exchange.h"
#include "holdfast/v1/denoise_service.pb.h"

namespace holdfast::client {

/// Turns one frame into messages: FrameBegin, the chunks of each plane, FrameEnd.
class FrameSender {
 public:
  FrameSender(OutgoingFrame frame, const std::vector<PlaneId>& planes)
      : out_(std::move(frame)), planes_(planes) {}

  /// Writes the next message to `request`; false if there is none left.
  bool next(v1::DenoiseRequest& request);

 private:
  const OutgoingFrame out_;
  const std::vector<PlaneId>& planes_;
  bool begun_ = false, ended_ = false;
  std::size_t plane_ = 0, offset_ = 0;
};

}  // namespace holdfast::client
