#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "client/sdk/exchange.h"
#include "proto/chunk_writer.h"
#include "proto/wire_profile.h"

namespace holdfast::client {

/// How a session writes its planes, with memory that its frames share.
struct PlaneWriter {
  const wire::WireProfile* profile = &wire::exact_profile();
  wire::ChunkWriter chunks;
};

/// Turns one frame into messages: FrameBegin, the chunks of each plane, FrameEnd.
class FrameSender {
 public:
  FrameSender(OutgoingFrame frame, const std::vector<PlaneId>& planes, PlaneWriter& writer)
      : out_(std::move(frame)), planes_(planes), writer_(writer) {}

  /// Makes the next message, which may refer to the frame's planes and holds the frame until it is
  /// sent; false if there is none left.
  bool next(wire::OutgoingMessage& message);

 private:
  const OutgoingFrame out_;
  const std::vector<PlaneId>& planes_;
  PlaneWriter& writer_;
  std::vector<wire::PlaneCoding> codings_;  ///< of planes_
  bool begun_ = false, ended_ = false;
  std::size_t plane_ = 0, offset_ = 0;
};

}  // namespace holdfast::client
