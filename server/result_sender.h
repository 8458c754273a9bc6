#pragma once

#include <cstddef>
#include <vector>

#include "proto/chunk_writer.h"
#include "server/frame_slot.h"
#include "server/session.h"

namespace holdfast::server {

/// Turns one answered frame into messages: FrameResult, then the chunks of each result plane.
class ResultSender {
 public:
  /// `chunks`: its memory is used.
  ResultSender(const FrameSlot& slot, const SessionConfig& config, wire::ChunkWriter& chunks)
      : slot_(slot), config_(config), chunks_(chunks) {}

  /// Makes the next message, which may refer to the answer's planes and holds the answer until it
  /// is sent; false if there is none left.
  bool next(wire::OutgoingMessage& message);

 private:
  const FrameSlot& slot_;
  const SessionConfig& config_;
  wire::ChunkWriter& chunks_;
  std::vector<wire::PlaneCoding> codings_;  ///< of the session's results, if they are sent
  bool begun_ = false;
  std::size_t plane_ = 0, offset_ = 0;
};

}  // namespace holdfast::server
