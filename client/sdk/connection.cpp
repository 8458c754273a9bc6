#include "client/sdk/connection.h"

namespace holdfast::client {
namespace {

// A failed write means that the stream has ended; its status, which says why, comes by itself.
constexpr std::chrono::milliseconds kEndAfterFailedWrite{1000};

}  // namespace

Connection::Connection(grpc::GenericStub& stub, Exchange& exchange, Config config,
                       const v1::Hello& hello)
    : exchange_(exchange),
      config_(std::move(config)),
      writer_{config_.wire, {}},
      assembler_(config_.results) {
  if (config_.shared_memory) cells_.emplace(config_.shared_memory, wire::SharedPart::kInput);
  const std::lock_guard lock(mutex_);  // reactions see a finished object, and wait for it here
  stub.PrepareBidiStreamingCall(&context_, "/holdfast.v1.DenoiseService/Denoise", {}, this);
  v1::DenoiseRequest first;
  *first.mutable_hello() = hello;
  wire::write_message(first, request_);
  writing_ = true;
  AddHold();
  StartWrite(&request_);
  StartRead(&received_);
  StartCall();
  if (config_.wire != &wire::exact_profile()) encoder_ = std::thread([this] { encode(); });
}

Connection::~Connection() {
  cancel();
  wait_end();
  if (encoder_.joinable()) encoder_.join();
}

grpc::Status Connection::wait_open(std::chrono::milliseconds timeout) {
  std::unique_lock lock(mutex_);
  const bool answered = changed_.wait_for(lock, timeout, [this] { return welcome_ || ended_; });
  if (answered && welcome_) return grpc::Status::OK;
  context_.TryCancel();
  changed_.wait(lock, [this] { return status_.has_value(); });
  if (!answered) status_ = {grpc::StatusCode::DEADLINE_EXCEEDED, "no Welcome"};
  return *status_;
}

grpc::Status Connection::wait_end() {
  std::unique_lock lock(mutex_);
  const auto over = [this] { return status_.has_value(); };
  changed_.wait(lock, [&] { return over() || write_failed_; });
  if (!changed_.wait_for(lock, kEndAfterFailedWrite, over)) {
    context_.TryCancel();
    changed_.wait(lock, over);
    status_ = {grpc::StatusCode::UNAVAILABLE, "a write failed, and the stream did not end"};
  }
  return *status_;
}

void Connection::pump() {
  const std::lock_guard lock(mutex_);
  write_on();
}

void Connection::cancel() {
  const std::lock_guard lock(mutex_);
  if (!ended_) context_.TryCancel();
}

bool Connection::shared_memory() const {
  const std::lock_guard lock(mutex_);
  return welcome_ && cells_.has_value();
}

// --- reactions -----------------------------------------------------------------------------------

void Connection::OnReadDone(bool ok) {
  bool release = false;
  {
    const std::lock_guard lock(mutex_);
    if (ok && violation_.empty()) try {
        handle_message();
        write_on();  // an answer is a credit
      } catch (const std::exception& error) {
        violation_ = error.what();
        context_.TryCancel();
      }
    if (ok) {
      StartRead(&received_);
    } else {
      ended_ = true;
      release = true;
      wake_.notify_all();
      changed_.notify_all();
    }
  }
  if (release) RemoveHold();
}

void Connection::handle_message() {
  wire::ChunkView* const chunk = chunks_.read(received_);
  if (chunk == nullptr) {
    if (!wire::parse_message(received_, response_))
      throw std::runtime_error("a message that is not a DenoiseResponse");
    handle_response();
    return;
  }
  add(*chunk);
}

void Connection::add(wire::ChunkView& chunk) {
  wire::find_shared(chunk, cells_ ? &cells_->reader : nullptr);
  exchange_.count(0, chunk.data_bytes);
  if (assembler_.add(chunk)) exchange_.answered(assembler_.take());
  if (!cells_) return;
  if (const auto read = cells_->reader.due()) read_cells_ = read;
}

/// The same for a message that is not a chunk, or one that is written in an unusual way.
void Connection::handle_response() {
  using Message = v1::DenoiseResponse;
  switch (response_.message_case()) {
    case Message::kWelcome:
      welcome_ = true;
      changed_.notify_all();  // not with each message: the keeper waits for the end all the time
      if (!response_.welcome().shared_memory()) cells_.reset();
      if (cells_) writer_.chunks.use(&cells_->writer);
      exchange_.opened(static_cast<int>(response_.welcome().credits()), config_.fresh);
      break;
    case Message::kFrameResult:
      if (assembler_.begin(response_.frame_result(), exchange_.answer_size(), exchange_.spare()))
        exchange_.answered(assembler_.take());
      break;
    case Message::kPlaneChunk: {
      wire::ChunkView chunk = wire::view_of(response_.plane_chunk());
      add(chunk);
      break;
    }
    case Message::kSharedRead:
      if (cells_) cells_->writer.note_read(response_.shared_read().cells());
      break;
    default:
      break;  // Draining: the server ends the stream itself once the frames in flight are answered
  }
}

void Connection::OnWriteDone(bool ok) {
  const std::lock_guard lock(mutex_);
  writing_ = false;
  if (ok) return write_on();
  write_failed_ = true;
  changed_.notify_all();
}

void Connection::OnDone(const grpc::Status& status) {
  const std::lock_guard lock(mutex_);
  ended_ = true;
  status_ = status;
  if (!violation_.empty())
    status_ = {grpc::StatusCode::INTERNAL, "the server broke the protocol: " + violation_};
  wake_.notify_all();
  changed_.notify_all();  // under the mutex: the destructor may be waiting
}

// --- writing -------------------------------------------------------------------------------------

void Connection::write_on() {
  if (encoder_.joinable()) {
    start_write();
    woken_ = true;
    wake_.notify_one();
    return;
  }
  if (writing_ || ended_ || write_failed_ || writes_done_ || !welcome_) return;
  if (write_read_cells()) return;
  if (!has_prepared_) has_prepared_ = next_message(prepared_, nullptr);
  start_write();
  end_writes();
}

/// Makes the next message, of the frame at hand or the next one; false if there is nothing to send
/// now. Takes `lock`, if given, off while it encodes.
bool Connection::next_message(wire::OutgoingMessage& message, std::unique_lock<std::mutex>* lock) {
  for (;;) {
    if (cells_ && cells_->writer.full()) return false;  // SharedRead will come
    if (!sender_) {
      std::optional<OutgoingFrame> frame = exchange_.next();
      if (!frame) return false;
      sender_.emplace(std::move(*frame), config_.planes, writer_);
    }
    if (lock != nullptr) lock->unlock();
    const bool made = sender_->next(message);
    if (lock != nullptr) lock->lock();
    if (made) return true;
    sender_.reset();
  }
}

/// Writes the prepared message, if there is one and none is being written.
void Connection::start_write() {
  if (write_failed_ || write_read_cells() || !has_prepared_ || writing_ || ended_) return;
  request_.Swap(&prepared_.bytes);
  has_prepared_ = false;
  exchange_.count(prepared_.plane_bytes, 0);
  writing_ = true;
  StartWrite(&request_);
}

/// Tells the server which cells of the results may be written again, before all else. True if that
/// is now being written.
bool Connection::write_read_cells() {
  if (!read_cells_ || writing_ || ended_ || writes_done_) return false;
  v1::DenoiseRequest request;
  request.mutable_shared_read()->set_cells(*std::exchange(read_cells_, {}));
  wire::write_message(request, request_);
  writing_ = true;
  StartWrite(&request_);
  return true;
}

/// Ends our side of the stream if everything is written and nothing will follow, nor any cell of
/// the results have to be told as read.
void Connection::end_writes() {
  if (writing_ || has_prepared_ || ended_ || writes_done_ || sender_ || !exchange_.all_sent())
    return;
  if (cells_ && !exchange_.complete()) return;
  writes_done_ = true;
  StartWritesDone();
}

/// The encoding thread.
void Connection::encode() {
  std::unique_lock lock(mutex_);
  for (;;) {
    wake_.wait(lock, [this] { return ended_ || (woken_ && welcome_ && !has_prepared_); });
    if (ended_) return;
    woken_ = false;
    has_prepared_ = next_message(prepared_, &lock);
    if (has_prepared_) woken_ = true;  // for the message after it
    start_write();
    end_writes();
  }
}

}  // namespace holdfast::client
