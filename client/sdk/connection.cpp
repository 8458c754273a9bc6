#include "client/sdk/connection.h"

#include "client/sdk/convert.h"
#include "client/sdk/status.h"
#include "proto/plane_bytes.h"

namespace holdfast::client {

using Clock = std::chrono::steady_clock;

Connection::Connection(v1::DenoiseService::Stub& stub, Config config, const v1::Hello& hello,
                       std::chrono::milliseconds timeout)
    : config_(std::move(config)), assembler_(config_.results, config_.width, config_.height) {
  std::unique_lock lock(mutex_);  // reactions see a finished object, and wait for it here
  stub.async()->Denoise(&context_, this);
  *request_.mutable_hello() = hello;
  writing_ = true;
  AddHold();
  StartWrite(&request_);
  StartRead(&response_);
  StartCall();
  const bool answered = changed_.wait_for(lock, timeout, [this] { return welcome_ || ended_; });
  if (answered && welcome_) return;
  context_.TryCancel();
  changed_.wait(lock, [this] { return status_.has_value(); });
  if (!answered) throw ConnectionError("server " + config_.address + " did not answer in time");
  throw_ended();
}

Connection::~Connection() {
  std::unique_lock lock(mutex_);
  if (!ended_) context_.TryCancel();
  changed_.wait(lock, [this] { return status_.has_value(); });
}

bool Connection::submit(std::shared_ptr<const Frame> frame, bool wait) {
  check_planes(*frame, config_.planes, config_.width, config_.height);
  std::unique_lock lock(mutex_);
  const auto in_flight = [this] { return static_cast<int>(pending_.size()); };
  if (!wait && !ended_ && in_flight() >= credits_) return false;
  changed_.wait(lock, [&] { return ended_ || in_flight() < credits_; });
  if (finishing_) throw std::logic_error("submit after finish");
  if (ended_) {
    changed_.wait(lock, [this] { return status_.has_value(); });
    throw_ended();
  }
  pending_.push_back({frame->index, Clock::now()});
  unsent_.push_back(std::move(frame));
  write_on();
  return true;
}

std::optional<FrameOutput> Connection::receive(bool wait) {
  std::unique_lock lock(mutex_);
  const auto over = [this] { return status_ || (finishing_ && pending_.empty()); };
  if (wait) changed_.wait(lock, [&] { return !outputs_.empty() || over(); });
  if (!outputs_.empty()) {
    FrameOutput output = std::move(outputs_.front());
    outputs_.pop_front();
    return output;
  }
  if (status_ && (!pending_.empty() || !status_->ok())) throw_ended();
  return {};
}

void Connection::finish() {
  const std::lock_guard lock(mutex_);
  finishing_ = true;
  write_on();
  changed_.notify_all();
}

grpc::Status Connection::wait_end() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return status_.has_value(); });
  return *status_;
}

void Connection::recycle(PlaneSet&& planes) {
  const std::lock_guard lock(mutex_);
  if (spare_.size() < static_cast<std::size_t>(credits_)) spare_.push_back(std::move(planes));
}

int Connection::credits() const {
  const std::lock_guard lock(mutex_);
  return credits_;
}

int Connection::in_flight() const {
  const std::lock_guard lock(mutex_);
  return static_cast<int>(pending_.size());
}

Traffic Connection::traffic() const {
  const std::lock_guard lock(mutex_);
  return traffic_;
}

// --- reactions -----------------------------------------------------------------------------------

void Connection::OnReadDone(bool ok) {
  bool release = false;
  {
    const std::lock_guard lock(mutex_);
    if (ok) try {
        handle_response();
      } catch (const std::exception& error) {
        violation_ = error.what();
        context_.TryCancel();
      }
    if (ok) {
      StartRead(&response_);
    } else {
      ended_ = true;
      release = true;
    }
    changed_.notify_all();
  }
  if (release) RemoveHold();
}

void Connection::handle_response() {
  using Message = v1::DenoiseResponse;
  if (!violation_.empty()) return;
  switch (response_.message_case()) {
    case Message::kWelcome:
      credits_ = static_cast<int>(response_.welcome().credits());
      welcome_ = true;
      break;
    case Message::kFrameResult: {
      PlaneSet reuse;
      if (!spare_.empty()) {
        reuse = std::move(spare_.back());
        spare_.pop_back();
      }
      if (assembler_.begin(response_.frame_result(), std::move(reuse))) complete();
      break;
    }
    case Message::kPlaneChunk:
      traffic_.received += response_.plane_chunk().data().size();
      if (assembler_.add(response_.plane_chunk())) complete();
      break;
    default:
      break;  // Draining: the server closes the stream itself once the frames in flight are
              // answered
  }
}

void Connection::complete() {
  FrameOutput output = assembler_.take();
  if (pending_.empty() || pending_.front().index != output.index)
    throw std::runtime_error("the server broke the protocol: answer to frame " +
                             std::to_string(output.index) + " out of turn");
  output.timing.total =
      std::chrono::duration<double, std::milli>(Clock::now() - pending_.front().submitted).count();
  pending_.pop_front();
  outputs_.push_back(std::move(output));
}

void Connection::OnWriteDone(bool ok) {
  const std::lock_guard lock(mutex_);
  writing_ = false;
  if (ok) write_on();
}

void Connection::write_on() {
  if (writing_ || ended_ || writes_done_) return;
  for (;;) {
    if (sender_ && sender_->next(request_)) {
      if (request_.has_plane_chunk()) traffic_.sent += request_.plane_chunk().data().size();
      writing_ = true;
      StartWrite(&request_);
      return;
    }
    sender_.reset();
    if (unsent_.empty()) break;
    sender_.emplace(std::move(unsent_.front()), config_.planes);
    unsent_.pop_front();
  }
  if (!finishing_) return;
  writes_done_ = true;
  StartWritesDone();
}

void Connection::OnDone(const grpc::Status& status) {
  const std::lock_guard lock(mutex_);
  ended_ = true;
  status_ = status;
  changed_.notify_all();  // under the mutex: the destructor may be waiting
}

void Connection::throw_ended() const {
  if (!violation_.empty()) throw RefusedError("server " + config_.address + ": " + violation_);
  if (status_->ok())
    throw ConnectionError("server " + config_.address + " ended the stream with frames in flight");
  throw_status(config_.address, *status_);
}

}  // namespace holdfast::client
