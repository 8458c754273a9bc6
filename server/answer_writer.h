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

  /// From now on answers use these cells, which outlive the writer.
  void use(wire::CellWriter& cells) {
    cells_ = &cells;
    chunks_.use(&cells);
  }
  /// The client has to be told that so many cells were read; only the last count is sent.
  void tell_read(std::uint64_t cells) { read_cells_ = cells; }

  /// The next message, valid until the next call; null if there is nothing to send. The message
  /// before it has been written, which ends an answer with its last one.
  const wire::OutgoingMessage* next(const Sent& sent);
  /// True if the next message may want a cell and none is free; made all the same, its bytes travel
  /// in it.
  bool waits_for_cell() const {
    return cells_ != nullptr && cells_->full() && !urgent() && !made_ && !answers_.empty();
  }

  /// True if the next message takes more than a copy: it is then made by `encode_ahead`, before
  /// `next` is called.
  bool needs_encoding();
  /// Makes the next message. `notice`, `tell_read`, `add` and `empty` may be called meanwhile,
  /// nothing else.
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
  /// Something goes before all answers.
  bool urgent() const { return !notices_.empty() || read_cells_; }
  void write_urgent();

  std::deque<v1::DenoiseResponse> notices_;
  std::optional<std::uint64_t> read_cells_;  ///< to be told
  std::deque<Entry> answers_;                ///< the first of which is being sent
  wire::CellWriter* cells_ = nullptr;
  wire::ChunkWriter chunks_;  ///< of the sender
  std::optional<ResultSender> sender_;
  FrameSlot* encoding_ = nullptr;  ///< of the sender
  wire::OutgoingMessage message_;
  std::optional<bool> made_;  ///< ahead: false if the answer had no message left
};

}  // namespace holdfast::server
