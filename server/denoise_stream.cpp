#include "server/denoise_stream.h"

#include "core/frame/error.h"
#include "proto/plane_bytes.h"
#include "proto/unix_buffers.h"
#include "server/error.h"
#include "server/late_frames.h"
#include "server/session_change.h"
#include "server/status.h"

namespace holdfast::server {

using Clock = std::chrono::steady_clock;

DenoiseStream* DenoiseStream::start(ServiceState& state, const std::string& peer) {
  const std::shared_ptr<DenoiseStream> stream(new DenoiseStream(state));
  stream->self_ = stream;
  std::unique_lock lock(stream->mutex_);
  try {
    state.streams.add(stream, peer);
    stream->read_on();
  } catch (...) {
    stream->refuse(std::current_exception());
  }
  stream->unlock_and_finish(lock);
  return stream.get();
}

// --- reading -------------------------------------------------------------------------------------

void DenoiseStream::OnReadDone(bool ok) {
  std::unique_lock lock(mutex_);
  reading_ = false;
  heir_ = false;
  if (!ok) {
    read_all_ = true;
    if (assembler_ && assembler_->open()) post(assembler_->abandon("the end of the stream"));
  } else if (!read_all_ && !broken_) {
    try {
      const std::size_t bytes = received_.Length();
      state_.metrics.received_bytes(bytes);
      shared_bytes_ = 0;
      const bool more = handle_message();
      if (closing_ && assembler_ && !assembler_->open()) end(status_);
      if (rates_) hold_reading(rates_->count_bytes(bytes + shared_bytes_, Clock::now()));
      if (more) read_on();
    } catch (...) {
      refuse(std::current_exception());
    }
  }
  const auto self = heir_ ? shared_from_this() : nullptr;  // outlives what follows
  const std::string taken_over = heir_ ? session_->id() : std::string();
  const SessionLife::Hold hold = hold_;
  unlock_and_finish(lock);
  // After the mutex: two streams that take each other's session over must not wait for each other.
  if (self) state_.streams.take_over(taken_over, hold);
}

/// True if the next message may be read.
bool DenoiseStream::handle_message() {
  if (wire::ChunkView* const chunk = chunks_.read(received_);
      chunk != nullptr && session_ && assembler_->open()) {
    decode(*chunk);
    return true;
  }
  if (!wire::parse_message(received_, request_))
    throw InputError("message", "must be a DenoiseRequest", "something else");
  return handle_request();
}

/// The same for a message that is not a chunk, or one at a wrong place.
bool DenoiseStream::handle_request() {
  using Message = v1::DenoiseRequest;
  const auto kind = request_.message_case();
  if (!session_) {
    if (kind != Message::kHello)
      throw InputError("first message of a stream", "must be Hello", "another");
    handle_hello(request_.hello());
    return true;
  }
  if (kind == Message::kFrameBegin) return handle_frame_begin(request_.frame_begin());
  if (kind == Message::kHello) throw InputError("Hello", "must be sent once", "sent again");
  if (kind == Message::MESSAGE_NOT_SET)
    throw InputError("message", "must be Hello, FrameBegin, PlaneChunk or FrameEnd", "empty");
  if (kind == Message::kSharedRead) {
    note_read(request_.shared_read());
    return true;
  }
  if (!assembler_->open())
    throw InputError(kind == Message::kPlaneChunk ? "PlaneChunk" : "FrameEnd",
                     "must be inside a frame", "outside");
  if (kind == Message::kPlaneChunk) {
    wire::ChunkView chunk = wire::view_of(request_.plane_chunk());
    decode(chunk);
  } else {
    post(assembler_->end(request_.frame_end()));
  }
  return true;
}

void DenoiseStream::handle_hello(const v1::Hello& hello) {
  const SessionTable::Attached attached = state_.sessions.attach(hello.session_id(), hello.token());
  session_ = attached.session;
  rates_ = attached.rates;
  watch_ = attached.watch;
  hold_ = attached.hold;
  heir_ = attached.taken_over;
  config_ = session_->config();
  assembler_.emplace(*config_);
  deadlines_.greeted();
  wire::widen_unix_buffers(state_.config.listen);
  state_.streams.greeted(this);
  const SessionCounters counters = session_->counters();
  v1::Welcome& welcome = *writer_.notice().mutable_welcome();
  welcome.set_credits(static_cast<std::uint32_t>(state_.config.limits.credits));
  welcome.set_resumed(counters.last_frame.has_value());
  welcome.set_last_frame_index(counters.last_frame.value_or(0));
  welcome.set_epoch(counters.epoch);
  attach_cells(hello);
  welcome.set_shared_memory(cells_.has_value());
  state_.log->info("event=stream_open session={} resumed={} taken_over={} shared={} last_acked={}",
                   session_->id(), welcome.resumed(), heir_, welcome.shared_memory(),
                   hello.has_last_acked_frame() ? hello.last_acked_frame() : -1);
  write_on();
}

/// True if the frame was begun; false if it has to wait for a slot.
bool DenoiseStream::handle_frame_begin(const v1::FrameBegin& begin) {
  if (assembler_->open()) post(assembler_->abandon("another FrameBegin"));
  FrameSlot* const slot = free_slot();
  const auto wait = slot ? rates_->admit_frame(Clock::now()) : SessionRates::Duration::zero();
  stalled_ = !slot || wait > SessionRates::Duration::zero();
  if (!stalled_) begin_frame(begin, *slot);
  if (stalled_ && slot) {
    free_.push_back(slot);
    hold_reading(wait);
  }
  return !stalled_;
}

void DenoiseStream::begin_frame(const v1::FrameBegin& begin, FrameSlot& slot) {
  const auto refusal = take_change(state_, session_, begin, config_, slot.reserved);
  slot.config = config_;
  if (slot.frame.planes.size() == 0 && !planes_.empty()) {
    slot.frame.planes = std::move(planes_.back());
    planes_.pop_back();
  }
  assembler_->follow(*config_);
  assembler_->begin(begin, slot);
  if (refusal) slot.error = refusal;
  open_ = &slot;
  slot.decode = slot.encode = {};
  deadlines_.frame_begun(slot.begun);
}

/// Nothing is read for that long: the windows of HTTP/2 fill, and the client waits.
void DenoiseStream::hold_reading(SessionRates::Duration time) {
  if (time <= SessionRates::Duration::zero()) return;
  const Clock::time_point now = Clock::now();
  read_due_ = std::max(read_due_.value_or(now), now + time);
  deadlines_.pause(now);
}

/// The FrameBegin that was held up tries again.
void DenoiseStream::begin_stalled() {
  if (!stalled_) return;
  stalled_ = false;
  if (!read_all_ && !broken_) handle_frame_begin(request_.frame_begin());
}

FrameSlot* DenoiseStream::free_slot() {
  if (free_.empty()) {
    if (slots_.size() == static_cast<std::size_t>(state_.config.limits.credits)) return nullptr;
    free_.push_back(slots_.emplace_back(std::make_unique<FrameSlot>()).get());
  }
  FrameSlot* const slot = free_.back();
  free_.pop_back();
  return slot;
}

void DenoiseStream::read_on() {
  if (reading_ || stalled_ || read_due_ || read_all_ || broken_ || finished_) return;
  reading_ = true;
  StartRead(&received_);
}

// --- filtering -----------------------------------------------------------------------------------

void DenoiseStream::post(FrameSlot& slot) {
  deadlines_.frame_ended();
  if (!slot.error) ++waiting_;
  state_.scheduler.post(
      session_->strand(), [self = shared_from_this(), &slot] { self->filter(slot); }, slot.deadline,
      slot.config->latest);
}

void DenoiseStream::filter(FrameSlot& slot) {
  slot.started = Clock::now();
  bool wanted = true, newer_waits = false;
  {
    const std::lock_guard lock(mutex_);
    wanted = !broken_;
    if (!slot.error) newer_waits = --waiting_ > 0;
  }
  const FrameTurn turn(slot.started, slot.deadline, slot.config->latest, newer_waits);
  if (wanted && slot.error) session_->count_error();
  if (wanted && !slot.error) try {
      slot.answer = session_->repeat(slot.frame.index, slot.epoch);
      slot.repeated = slot.answer != nullptr;
      slot.late = turn.late && !slot.repeated;
      if (!slot.answer && turn.drop) slot.answer = session_->drop(slot.frame, slot.epoch);
      if (!slot.answer)
        slot.answer = session_->filter(slot.frame, slot.epoch, slot.ended, slot.config);
    } catch (...) {
      slot.error = frame_error_from(std::current_exception());
    }
  slot.reserved.reset();
  slot.answered = Clock::now();
  if (wanted) log_frame(slot);
  if (wanted && state_.config.admin_previews) show_frame(slot);
  if (wanted) state_.metrics.filtered(slot);
  std::unique_lock lock(mutex_);
  if (slot.frame.planes.size() > 0) planes_.push_back(std::exchange(slot.frame.planes, {}));
  if (broken_) {
    release(slot);
  } else {
    writer_.add(slot, *slot.config);
    write_on();
  }
  unlock_and_finish(lock);
}

void DenoiseStream::log_frame(const FrameSlot& slot) const {
  if (slot.error)
    state_.log->warn("event=frame_error session={} frame={} error=\"{}\"", session_->id(),
                     slot.frame.index, slot.error->message());
  else
    state_.log->debug("event=frame session={} frame={} preset={} core_ms={:.2f} reset={}",
                      session_->id(), slot.frame.index, slot.answer->report.preset,
                      slot.answer->report.ms, slot.answer->report.history_reset);
  if (slot.error || slot.repeated) return;
  if (const auto repairs = watch_->repairs().note(slot.answer->report, slot.answered))
    state_.log->warn("event=repaired session={} {}", session_->id(), *repairs);
}

/// For the live page, if somebody looks at it.
void DenoiseStream::show_frame(const FrameSlot& slot) const try {
  const Clock::time_point now = Clock::now();
  if (slot.error || slot.repeated || slot.answer->dropped || !watch_->preview().wanted(now)) return;
  watch_->preview().put(preview(slot.frame, slot.answer->results), now);
} catch (const std::exception& error) {  // a picture for onlookers costs no frame
  state_.log->warn("event=no_preview session={} error=\"{}\"", session_->id(), error.what());
}

// --- ending --------------------------------------------------------------------------------------

void DenoiseStream::OnCancel() {
  std::unique_lock lock(mutex_);
  broken_ = true;
  if (!writing_) drop_unsent();  // else the message being written may belong to a slot
  unlock_and_finish(lock);
}

void DenoiseStream::yield(SessionLife::Hold hold) {
  std::unique_lock lock(mutex_);
  if (hold_ >= hold) return;
  if (status_.ok())
    status_ = status_from(std::make_exception_ptr(
        RefusedError(Refusal::kTakenOver, "a newer stream has the session")));
  broken_ = true;
  if (!writing_) drop_unsent();
  unlock_and_finish(lock);
}

void DenoiseStream::tick(StreamDeadlines::TimePoint now) {
  std::unique_lock lock(mutex_);
  if (read_due_ && now >= *read_due_) {
    read_due_.reset();
    deadlines_.resume(now);
    begin_stalled();
    read_on();
  }
  if (deadlines_.passed(now) && !read_all_ && !broken_) {
    const bool in_frame = assembler_ && assembler_->open();
    if (in_frame) post(assembler_->abandon("nothing within the limit frame-timeout-ms"));
    refuse(std::make_exception_ptr(RefusedError(
        Refusal::kTooSlow, in_frame ? "a frame was not whole within the limit frame-timeout-ms"
                                    : "no Hello came within the limit hello-timeout-ms")));
  }
  unlock_and_finish(lock);
}

void DenoiseStream::drain(std::chrono::milliseconds deadline) {
  std::unique_lock lock(mutex_);
  writer_.notice().mutable_draining()->set_deadline_ms(
      static_cast<std::uint32_t>(deadline.count()));
  write_on();
  lock.unlock();
  close(status_from(
      std::make_exception_ptr(RefusedError(Refusal::kDraining, "the server is shutting down"))));
}

void DenoiseStream::close(const grpc::Status& status) {
  std::unique_lock lock(mutex_);
  closing_ = true;
  if (status_.ok()) status_ = status;
  if (!assembler_ || !assembler_->open()) end(status);
  unlock_and_finish(lock);
}

void DenoiseStream::refuse(std::exception_ptr error) {
  state_.metrics.refused(error);
  end(status_from(std::move(error)));
}

/// Nothing more is read; what is in flight is still answered.
void DenoiseStream::end(const grpc::Status& status) {
  if (status_.ok()) status_ = status;
  read_all_ = true;
  stalled_ = false;
  if (assembler_ && assembler_->open()) post(assembler_->abandon("the end of the stream"));
}

bool DenoiseStream::ready_to_finish() {
  if (finished_ || writing_ || !(read_all_ || broken_)) return false;
  if (broken_ && assembler_ && assembler_->open()) release(assembler_->abandon("a disconnect"));
  return free_.size() == slots_.size() && writer_.empty();
}

void DenoiseStream::unlock_and_finish(std::unique_lock<std::mutex>& lock) {
  if (cells_ && !hears()) write_on();  // no SharedRead will come for what waits
  const bool now = ready_to_finish();
  if (now) {
    finished_ = true;
    discard_cells();
    if (session_) {
      state_.sessions.detach(*session_, hold_);
      state_.log->info("event=stream_end session={} broken={} status={}", session_->id(), broken_,
                       static_cast<int>(status_.error_code()));
    }
  }
  const grpc::Status status = status_;
  lock.unlock();
  if (now) Finish(status);
}

void DenoiseStream::OnDone() {
  // gRPC has ordered every reaction before this one; the mutex makes that order our own.
  { const std::lock_guard lock(mutex_); }
  state_.streams.remove(this);
  self_.reset();  // deletes this, unless a job is just returning
}

std::string DenoiseStream::session_id() const {
  const std::lock_guard lock(mutex_);
  return session_ ? session_->id() : std::string();
}

}  // namespace holdfast::server
