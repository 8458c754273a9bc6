#pragma once

#include <cstdint>
#include <exception>
#include <vector>

#include "holdfast/v1/denoise_service.pb.h"
#include "proto/chunk_message.h"
#include "proto/plane_coder.h"
#include "server/frame_slot.h"
#include "server/session.h"

namespace holdfast::server {

/// Puts a frame together from its messages. A message that breaks a rule leaves a named error in
/// the slot; the rest of that frame is then dropped unread. Allocates planes by the session's
/// declaration only, never by a size from the wire.
class FrameAssembler {
 public:
  explicit FrameAssembler(const SessionConfig& config) : config_(&config) {}

  /// The configuration of the frames that begin from now on; outlives them.
  void follow(const SessionConfig& config) { config_ = &config; }

  /// True between `begin` and `end` or `abandon`.
  bool open() const { return slot_ != nullptr; }

  /// Starts a frame in `slot`.
  void begin(const v1::FrameBegin& message, FrameSlot& slot);
  /// Adds a piece of a plane to the open frame.
  void add(const wire::ChunkView& chunk);
  /// Makes `error` that of the open frame, unless it has one.
  void fail(std::exception_ptr error);
  /// Closes the open frame and returns its slot, with an error if it is not complete.
  FrameSlot& end(const v1::FrameEnd& message);
  /// Closes the open frame as incomplete, because `instead` came where FrameEnd had to.
  FrameSlot& abandon(const char* instead);

 private:
  /// How much of a declared plane has come. `plane` is null if the frame did not announce it.
  struct Progress {
    Plane* plane = nullptr;
    wire::PlaneCoding coding;
    std::uint64_t size = 0, received = 0;  ///< bytes before the codec
    bool complete = false;
  };

  void announce(const v1::FramePlane& message);
  void write(const wire::ChunkView& chunk);
  FrameSlot& close();

  const SessionConfig* config_;
  FrameSlot* slot_ = nullptr;
  std::vector<Progress> progress_;  ///< by position in the session's planes
  wire::PlaneCoder coder_;
};

}  // namespace holdfast::server
