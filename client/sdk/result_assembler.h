#pragma once

#include <optional>
#include <vector>

#include <holdfast/client.h>

#include "core/frame/plane_size.h"
#include "holdfast/v1/denoise_service.pb.h"
#include "proto/chunk_message.h"
#include "proto/plane_coder.h"

namespace holdfast::client {

/// Puts an answer together from its messages. Throws std::runtime_error if the server breaks the
/// protocol; sizes follow from the frames, never from the wire.
class ResultAssembler {
 public:
  explicit ResultAssembler(std::vector<PlaneId> results) : results_(std::move(results)) {}

  /// Starts an answer with FrameResult. `size`: of its frame; `reuse`: planes whose memory it may
  /// take. True if the answer is complete.
  bool begin(const v1::FrameResult& result, PlaneSize size, PlaneSet&& reuse);
  /// Adds a piece; true if the answer is complete.
  bool add(const wire::ChunkView& chunk);
  /// The complete answer.
  FrameOutput take();

 private:
  const std::vector<PlaneId> results_;
  wire::PlaneCoder coder_;
  std::vector<wire::PlaneCoding> codings_;  ///< of results_
  std::optional<FrameOutput> output_;
  std::size_t plane_ = 0;
  std::uint64_t received_ = 0;  ///< bytes of plane_, before the codec
};

}  // namespace holdfast::client
