#pragma once

#include <deque>
#include <functional>
#include <optional>
#include <vector>

#include "holdfast/v1/denoise_service.pb.h"
#include "proto/chunk_writer.h"
#include "server/frame_slot.h"
#include "server/result_sender.h"

namespace holdfast::server {

/// What one stream has to send: notices before all else, then answers in the order in which they
/// were added. One thread at a time, but for `encode_ahead`.
class AnswerWriter {
 public:
  /// Called when the last message of an answer has been written.
  using Sent = std::function<void(FrameSlot& slot)>;

  /// A message to be filled: Welcome or Draining.
  v1::DenoiseResponse& notice() { return notices_.emplace_back(); }
  /// Adds an answered frame of a session with that configuration; both stay until it is sent or
  /// dropped.
  void add(FrameSlot& slot, const SessionConfig& config);

  /// The next message, valid until the next call; null if there is nothing to send. The message
  /// before it has been written, which ends an answer with its last one.
  const grpc::ByteBuffer* next(const Sent& sent);

  /// True if the next message takes more than a copy: it is then made by `encode_ahead`, before
  /// `next` is called.
  bool needs_encoding();
  /// Makes the next message. `notice`, `add` and `empty` may be called meanwhile, nothing else.
  void encode_ahead();

  /// Drops what is not sent; returns the slots.
  std::vector<FrameSlot*> drop();
  bool empty() const { return notices_.empty() && answers_.empty(); }

 private:
  struct Entry {
    FrameSlot* slot;
    const SessionConfig* config;
  };
  const Entry& begin();

  std::deque<v1::DenoiseResponse> notices_;
  std::deque<Entry> answers_;  ///< the first of which is being sent
  wire::ChunkWriter chunks_;   ///< of the sender
  std::optional<ResultSender> sender_;
  FrameSlot* encoding_ = nullptr;  ///< of the sender
  wire::OutgoingMessage message_;
  std::optional<bool> made_;  ///< ahead: false if the answer had no message left
};

}  // namespace holdfast::server
