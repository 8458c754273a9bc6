// The writing side of DenoiseStream.
#include "server/denoise_stream.h"

namespace holdfast::server {

using Clock = std::chrono::steady_clock;

void DenoiseStream::OnWriteDone(bool ok) {
  std::unique_lock lock(mutex_);
  writing_ = false;
  if (!ok) broken_ = true;
  if (broken_)
    drop_unsent();
  else
    write_on();
  unlock_and_finish(lock);
}

void DenoiseStream::write_on() {
  if (writing_ || broken_ || finished_) return;
  if (writer_.waits_for_cell() && hears()) return;  // SharedRead is to come
  const wire::OutgoingMessage* const message = next_message();
  writing_ = message != nullptr || writer_.needs_encoding();
  if (message != nullptr) {
    state_.metrics.sent_bytes(message->bytes.Length() + message->shared_bytes);
    StartWrite(&message->bytes);
  } else if (writing_) {
    state_.encoders.post([self = shared_from_this()] { self->encode(); });
  }
}

/// Null if there is nothing to send, or nothing before it is encoded.
const wire::OutgoingMessage* DenoiseStream::next_message() {
  if (writer_.needs_encoding()) return nullptr;
  return writer_.next([this](FrameSlot& slot) {
    const Clock::time_point now = Clock::now();
    state_.metrics.sent(slot, now);
    watch_->sent(slot, slot.answer ? slot.answer->report.preset : std::string(), now);
    release(slot);
  });
}

/// Without the mutex; `writing_` keeps others away from what it touches.
void DenoiseStream::encode() {
  bool good = true;
  try {
    writer_.encode_ahead();
  } catch (const std::exception& error) {  // out of memory: the client comes back for its answers
    state_.log->error("event=encode_failed error=\"{}\"", error.what());
    good = false;
  }
  OnWriteDone(good);
}

/// Makes the slot free and lets a waiting FrameBegin have it.
void DenoiseStream::release(FrameSlot& slot) {
  slot.answer.reset();
  free_.push_back(&slot);
  if (!stalled_ || read_due_) return;
  begin_stalled();
  read_on();
}

void DenoiseStream::drop_unsent() {
  for (FrameSlot* const slot : writer_.drop()) {
    slot->answer.reset();
    free_.push_back(slot);
  }
}

}  // namespace holdfast::server
