#include "server/session.h"

#include <algorithm>
#include <new>
#include <utility>

#include "core/frame/error.h"
#include "proto/plane_bytes.h"
#include "server/error.h"

namespace holdfast::server {
namespace {

SessionBytes bytes_of(const Denoiser& denoiser) {
  return {denoiser.held_bytes(), denoiser.scratch_bytes()};
}

}  // namespace

Session::Session(std::string id, std::string token, SessionConfig config, int remembered,
                 std::shared_ptr<ScratchPool> scratch)
    : id_(std::move(id)),
      token_(std::move(token)),
      scratch_(std::move(scratch)),
      config_(std::make_shared<const SessionConfig>(std::move(config))),
      denoiser_(std::in_place, config_->denoiser, scratch_),
      denoiser_bytes_(bytes_of(*denoiser_)),
      plan_text_(denoiser_->plan_text()),
      ledger_(static_cast<std::size_t>(remembered)) {
  if (!config_->preset_ms.empty()) chooser_.emplace(config_->preset_ms, config_->budget_ms);
}

void Session::follow(std::shared_ptr<const SessionConfig> config) {
  if (!denoiser_) denoiser_.emplace(config_->denoiser, scratch_);
  try {
    denoiser_.emplace(Denoiser(config->denoiser, *denoiser_));
  } catch (const std::bad_alloc&) {
    throw RefusedError("there is no memory for the session as it was to be", {"memory", {}});
  }
  std::string plan_text = denoiser_->plan_text();
  chooser_.reset();
  if (!config->preset_ms.empty()) chooser_.emplace(config->preset_ms, config->budget_ms);
  const std::lock_guard lock(mutex_);
  config_ = std::move(config);
  denoiser_bytes_ = bytes_of(*denoiser_);
  plan_text_ = std::move(plan_text);
}

std::shared_ptr<const Answer> Session::filter(Frame& frame, std::uint64_t epoch,
                                              std::optional<TimePoint> complete,
                                              std::shared_ptr<const SessionConfig> config) {
  const TimePoint start = std::chrono::steady_clock::now();
  // Taken for this frame only, also if it is refused: a bad transform must not spoil all that
  // follow.
  if (const auto carried = std::exchange(carried_, {}); carried && carried->epoch == epoch) {
    frame.objects.insert(carried->objects.begin(), carried->objects.end());
    frame.lights.insert(carried->lights.begin(), carried->lights.end());
    frame.cut |= carried->cut;
  }
  try {
    if (epoch < epoch_)
      throw InputError("epoch of frame " + std::to_string(frame.index),
                       "must be at least " + std::to_string(epoch_), std::to_string(epoch));
    if (config && config != config_) follow(std::move(config));
    if (epoch > epoch_ || !denoiser_) {
      denoiser_.reset();  // first, so that there are never two histories
      denoiser_.emplace(config_->denoiser, scratch_);
      if (epoch > epoch_) next_reset_ = ResetReason::kEpoch;
      epoch_ = epoch;
    }
    if (chooser_) choose_preset();
    const std::shared_ptr<Answer> answer = ledger_.fresh();
    answer->report = denoiser_->filter(frame, answer->results);
    if (chooser_) note_cost(answer->report, complete, start);
    answer->epoch = epoch;
    if (answer->report.history_reset)
      answer->reset =
          frame.cut && next_reset_ == ResetReason::kNone ? ResetReason::kCut : next_reset_;
    next_reset_ = ResetReason::kNone;
    ledger_.keep(answer);
    const std::lock_guard lock(mutex_);
    counters_.last_frame = frame.index;
    counters_.epoch = epoch;
    ++counters_.frames;
    return answer;
  } catch (const InputError&) {
    count_error();
    throw;
  } catch (const RefusedError&) {
    count_error();
    throw;
  } catch (...) {
    if (denoiser_) denoiser_->reset();
    next_reset_ = ResetReason::kFailure;
    count_error();
    throw;
  }
}

void Session::choose_preset() {
  const std::string& preset = kernel_preset_names()[chooser_->preset()];
  if (preset != denoiser_->config().preset) denoiser_->set_preset(preset);
}

/// What a frame has cost of the budget: its time in the core, but for that of changing the preset,
/// and the time for which other sessions kept the core from it. The wait for the session's own
/// frames before it is the client's pace. A frame in which components rested is cheap under any
/// preset, and a change of preset would end the rest: it says nothing.
void Session::note_cost(const FrameReport& report, std::optional<TimePoint> complete,
                        TimePoint start) {
  double core_ms = report.ms;
  for (const StageTime& stage : report.stages)
    if (stage.stage == "preset") core_ms -= stage.ms;
  double waited_ms = 0;
  if (complete)
    waited_ms =
        std::chrono::duration<double, std::milli>(start - std::max(*complete, last_end_)).count();
  last_end_ = std::chrono::steady_clock::now();
  if (report.rested.empty()) chooser_->measured(core_ms, waited_ms);
}

std::shared_ptr<const Answer> Session::drop(const Frame& frame, std::uint64_t epoch) {
  const SessionCounters last = counters();
  if (epoch < epoch_ || (epoch == last.epoch && last.last_frame && frame.index <= *last.last_frame))
    return nullptr;
  Carried carried;
  if (carried_ && carried_->epoch == epoch) {
    if (frame.index <= carried_->index) return nullptr;
    carried = std::move(*carried_);
  }
  carried.epoch = epoch;
  carried.index = frame.index;
  carried.cut |= frame.cut;
  for (const auto& [id, matrix] : frame.objects) carried.objects.insert_or_assign(id, matrix);
  for (const auto& [id, matrix] : frame.lights) carried.lights.insert_or_assign(id, matrix);
  carried_ = std::move(carried);
  const std::shared_ptr<Answer> answer = ledger_.fresh();
  answer->epoch = epoch;
  answer->report.index = frame.index;
  answer->dropped = true;
  ledger_.keep(answer);
  return answer;
}

std::shared_ptr<const Answer> Session::repeat(std::int64_t index, std::uint64_t epoch) {
  std::shared_ptr<const Answer> answer = ledger_.find(epoch, index);
  if (answer) {
    const std::lock_guard lock(mutex_);
    ++counters_.repeated;
  }
  return answer;
}

void Session::count_error() {
  const std::lock_guard lock(mutex_);
  ++counters_.frame_errors;
}

std::shared_ptr<const SessionConfig> Session::config() const {
  const std::lock_guard lock(mutex_);
  return config_;
}

SessionBytes Session::denoiser_bytes() const {
  const std::lock_guard lock(mutex_);
  return denoiser_bytes_;
}

std::string Session::plan_text() const {
  const std::lock_guard lock(mutex_);
  return plan_text_;
}

SessionCounters Session::counters() const {
  const std::lock_guard lock(mutex_);
  return counters_;
}

std::size_t frame_bytes(const DenoiserConfig& config, int credits) {
  const auto bytes_of = [&](const std::vector<PlaneId>& planes) {
    std::size_t bytes = 0;
    for (const PlaneId id : planes)
      bytes += wire::plane_bytes(id, plane_size(id, config.width, config.height));
    return bytes;
  };
  const auto frames = static_cast<std::size_t>(credits);
  return bytes_of(config.planes) * frames + bytes_of(result_planes(config)) * (frames + 1);
}

SessionBytes estimated_denoiser_bytes(const DenoiserConfig& config) {
  constexpr int kProbeSize = 256;  // pixels; small, but padding is a small part of it
  DenoiserConfig probe = config;
  probe.width = std::min(config.width, kProbeSize);
  probe.height = std::min(config.height, kProbeSize);
  const double area = static_cast<double>(config.width) * config.height;
  const double probe_area = static_cast<double>(probe.width) * probe.height;
  const SessionBytes of_probe = bytes_of(Denoiser(probe));
  const auto scaled = [&](std::size_t bytes) {
    return static_cast<std::size_t>(static_cast<double>(bytes) * (area / probe_area));
  };
  return {scaled(of_probe.own), scaled(of_probe.scratch)};
}

}  // namespace holdfast::server
