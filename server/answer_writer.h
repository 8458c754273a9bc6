#pragma once

#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "holdfast/v1/denoise_service.pb.h"
#include "server/frame_slot.h"
#include "server/result_sender.h"

namespace holdfast::server {

/// What one stream has to send: notices before all else, then answers in the order in which they
/// were added. One thread at a time.
class AnswerWriter {
 public:
  /// Called when the last message of an answer has been written. `preset`: the one it names.
  using Sent = std::function<void(FrameSlot& slot, const std::string& preset)>;

  /// A message to be filled: Welcome or Draining.
  v1::DenoiseResponse& notice() { return notices_.emplace_back(); }
  /// Adds an answered frame of a session with that configuration; both stay until it is sent or
  /// dropped.
  void add(FrameSlot& slot, const SessionConfig& config);

  /// The next message, valid until the next call; null if there is nothing to send. The message
  /// before it has been written, which ends an answer with its last one.
  const v1::DenoiseResponse* next(const Sent& sent);

  /// Drops what is not sent; returns the slots.
  std::vector<FrameSlot*> drop();
  bool empty() const { return notices_.empty() && answers_.empty(); }

 private:
  struct Entry {
    FrameSlot* slot;
    const SessionConfig* config;
  };
  bool encode(FrameSlot& slot);

  std::deque<v1::DenoiseResponse> notices_;
  std::deque<Entry> answers_;  ///< the first of which is being sent
  wire::PlaneCoder coder_;     ///< of the sender
  std::optional<ResultSender> sender_;
  std::string preset_;  ///< of the answer that is being sent
  v1::DenoiseResponse response_;
};

}  // namespace holdfast::server
