#include "client/sdk/exchange.h"

#include <algorithm>
#include <utility>

#include "client/sdk/convert.h"

namespace holdfast::client {
namespace {

void update(TransformTable& table, const TransformTable& newer) {
  for (const auto& [id, matrix] : newer) table.insert_or_assign(id, matrix);
}

}  // namespace

// --- the user's side -----------------------------------------------------------------------------

bool Exchange::submit(std::shared_ptr<const Frame> frame, bool wait) {
  std::unique_lock lock(mutex_);
  check_planes(*frame, config_.planes, size_.width, size_.height);
  const auto may = [this] { return closed_ || static_cast<int>(pending_.size()) < credits_; };
  if (!wait && !may()) return false;
  changed_.wait(lock, may);
  if (finishing_) throw std::logic_error("submit after finish");
  if (closed_) std::rethrow_exception(error_);
  pending_.push_back({std::move(frame), epoch_, Clock::now(), change_});
  ++unsent_;
  return true;
}

std::optional<FrameOutput> Exchange::receive(bool wait) {
  std::unique_lock lock(mutex_);
  const auto over = [this] { return closed_ || (finishing_ && pending_.empty()); };
  if (wait) changed_.wait(lock, [&] { return !outputs_.empty() || over(); });
  if (!outputs_.empty()) {
    FrameOutput output = std::move(outputs_.front());
    outputs_.pop_front();
    return output;
  }
  if (closed_ && error_) std::rethrow_exception(error_);
  return {};
}

void Exchange::finish() {
  const std::lock_guard lock(mutex_);
  finishing_ = true;
  changed_.notify_all();
}

void Exchange::restart() {
  const std::lock_guard lock(mutex_);
  ++epoch_;
}

void Exchange::change(const SessionChange& change) {
  for (const int size : {change.width, change.height})
    if (size < 0 || size > kMaxDimension)
      throw InputError("size", "must be in 1.." + std::to_string(kMaxDimension) + ", or 0",
                       std::to_string(size));
  const std::lock_guard lock(mutex_);
  SessionChange whole = change_ ? *change_ : SessionChange{};
  if (change.width != 0) size_.width = change.width;
  if (change.height != 0) size_.height = change.height;
  if (!change.recipe.empty()) whole.recipe = change.recipe;
  if (!change.preset.empty()) whole.preset = change.preset;
  whole.width = size_.width;
  whole.height = size_.height;
  change_ = std::make_shared<const SessionChange>(std::move(whole));
}

PlaneSize Exchange::size_of(const Pending& pending) const {
  if (pending.change) return {pending.change->width, pending.change->height};
  return {config_.width, config_.height};
}

void Exchange::recycle(PlaneSet&& planes) {
  const std::lock_guard lock(mutex_);
  if (spare_.size() < static_cast<std::size_t>(credits_)) spare_.push_back(std::move(planes));
}

int Exchange::credits() const {
  const std::lock_guard lock(mutex_);
  return credits_;
}

int Exchange::in_flight() const {
  const std::lock_guard lock(mutex_);
  return static_cast<int>(pending_.size());
}

Traffic Exchange::traffic() const {
  const std::lock_guard lock(mutex_);
  return traffic_;
}

int Exchange::reconnects() const {
  const std::lock_guard lock(mutex_);
  return std::max(0, streams_ - 1);
}

// --- the connection's side -----------------------------------------------------------------------

void Exchange::opened(int credits, bool fresh) {
  const std::lock_guard lock(mutex_);
  credits_ = credits;
  sent_.clear();
  warming_.clear();
  unsent_ = pending_.size();
  if (fresh && streams_ > 0) {
    warming_ = recent_;
    first_of_fresh_ = true;
    history_lost_ = true;
  }
  ++streams_;
  changed_.notify_all();
}

std::optional<OutgoingFrame> Exchange::next() {
  const std::lock_guard lock(mutex_);
  if (static_cast<int>(sent_.size()) >= credits_) return {};
  OutgoingFrame out;
  if (!warming_.empty()) {
    const Pending& warming = warming_.front();
    out.frame = warming.frame;
    out.epoch = warming.epoch;
    out.change = warming.change;
    sent_.push_back({out.frame->index, size_of(warming), true});
    warming_.pop_front();
  } else if (unsent_ > 0) {
    const Pending& pending = pending_[pending_.size() - unsent_--];
    out.frame = pending.frame;
    out.epoch = pending.epoch;
    out.change = pending.change;
    out.deadline_ms = config_.deadline_ms;
    sent_.push_back({out.frame->index, size_of(pending), false});
  } else {
    return {};
  }
  if (std::exchange(first_of_fresh_, false)) {
    out.objects = old_objects_;
    out.lights = old_lights_;
  }
  return out;
}

bool Exchange::all_sent() const {
  const std::lock_guard lock(mutex_);
  return finishing_ && unsent_ == 0 && warming_.empty();
}

void Exchange::answered(FrameOutput&& output) {
  const std::lock_guard lock(mutex_);
  if (sent_.empty() || sent_.front().index != output.index)
    throw std::runtime_error("answer to frame " + std::to_string(output.index) + " out of turn");
  const bool warming = sent_.front().warming;
  sent_.pop_front();
  if (warming) {
    if (spare_.size() < static_cast<std::size_t>(credits_))
      spare_.push_back(std::move(output.planes));
    return;
  }
  output.timing.total =
      std::chrono::duration<double, std::milli>(Clock::now() - pending_.front().submitted).count();
  output.history_lost = std::exchange(history_lost_, false);
  last_answered_ = output.index;
  if (!output.error) remember(pending_.front());
  pending_.pop_front();
  outputs_.push_back(std::move(output));
  changed_.notify_all();
}

void Exchange::remember(const Pending& pending) {
  if (pending.epoch != recent_epoch_) {  // the server starts anew as well
    recent_.clear();
    old_objects_.clear();
    old_lights_.clear();
    recent_epoch_ = pending.epoch;
  }
  if (pending.frame->cut)  // what was before warms nothing
    while (!recent_.empty()) forget_oldest();
  recent_.push_back(pending);
  while (recent_.size() > static_cast<std::size_t>(config_.rewarm_frames)) forget_oldest();
}

void Exchange::forget_oldest() {
  update(old_objects_, recent_.front().frame->objects);
  update(old_lights_, recent_.front().frame->lights);
  recent_.pop_front();
}

PlaneSet Exchange::spare() {
  const std::lock_guard lock(mutex_);
  if (spare_.empty()) return {};
  PlaneSet planes = std::move(spare_.back());
  spare_.pop_back();
  return planes;
}

PlaneSize Exchange::answer_size() const {
  const std::lock_guard lock(mutex_);
  if (sent_.empty()) throw std::runtime_error("an answer came to no frame");
  return sent_.front().size;
}

void Exchange::count(std::uint64_t sent, std::uint64_t received) {
  const std::lock_guard lock(mutex_);
  traffic_.sent += sent;
  traffic_.received += received;
}

std::optional<std::int64_t> Exchange::last_answered() const {
  const std::lock_guard lock(mutex_);
  return last_answered_;
}

bool Exchange::complete() const {
  const std::lock_guard lock(mutex_);
  return finishing_ && pending_.empty();
}

void Exchange::close(std::exception_ptr error) {
  const std::lock_guard lock(mutex_);
  closed_ = true;
  error_ = std::move(error);
  changed_.notify_all();
}

void Exchange::check_closed() const {
  const std::lock_guard lock(mutex_);
  if (error_) std::rethrow_exception(error_);
}

}  // namespace holdfast::client
