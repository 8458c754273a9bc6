#include "server/preset_chooser.h"

#include <algorithm>

namespace holdfast::server {
namespace {

/// A correction beyond this is not believed: something else must have changed meanwhile.
constexpr double kMostCorrection = 4;

/// Of the last `count` values, or of all if there are fewer; of none, `otherwise`.
double median(const std::deque<double>& values, std::size_t count, double otherwise) {
  if (values.empty()) return otherwise;
  const auto some = static_cast<std::ptrdiff_t>(std::min(count, values.size()));
  std::vector<double> last(values.end() - some, values.end());
  const auto middle = last.begin() + some / 2;
  std::nth_element(last.begin(), middle, last.end());
  return *middle;
}

template <class T>
void push(std::deque<T>& values, T value, std::size_t most) {
  values.push_back(value);
  if (values.size() > most) values.pop_front();
}

}  // namespace

PresetChooser::PresetChooser(std::vector<double> expected_ms, double budget_ms)
    : given_ms_(std::move(expected_ms)), cost_ms_(given_ms_), budget_ms_(budget_ms) {
  for (std::size_t k = 0; k < given_ms_.size(); ++k)
    if (given_ms_[k] <= kClear * budget_ms_) preset_ = k;
}

/// What a frame should take now, judged by the last `frames`.
double PresetChooser::expected(std::size_t preset, std::size_t frames) const {
  return cost_ms_[preset] * median(loads_, frames, 1) + median(waits_, frames, 0);
}

bool PresetChooser::missed() const {
  return std::count(misses_.begin(), misses_.end(), true) >
         static_cast<std::ptrdiff_t>(kMissesAllowed);
}

void PresetChooser::measured(double core_ms, double waited_ms) {
  if (unjudged_ > 0) {
    --unjudged_;
    return;
  }
  push(loads_, core_ms / cost_ms_[preset_], kRemembered);
  push(waits_, waited_ms, kRemembered);
  push(misses_, core_ms + waited_ms > budget_ms_, kJudged);
  for (std::size_t k = preset_ + 1; k < cost_ms_.size(); ++k) {
    const double whole = given_ms_[k] * (cost_ms_[preset_] / given_ms_[preset_]);
    cost_ms_[k] += kForgets * (whole - cost_ms_[k]);
  }
  if (trial_ > 0) {
    if (++trial_ == kRemembered + 1) learn();
    if (trial_ > kTrial) end_trial(true);
  }
  if (missed() && preset_ > 0)
    go_down();
  else
    consider_up();
}

void PresetChooser::go_down() {
  if (trial_ > 0) end_trial(false);
  std::size_t next = preset_ - 1;
  while (next > 0 && expected(next, kJudged) > budget_ms_) --next;
  go_to(next);
}

void PresetChooser::consider_up() {
  const std::size_t better = preset_ + 1;
  if (better == cost_ms_.size()) return;
  calm_ = expected(better, kRemembered) <= kClear * budget_ms_ ? calm_ + 1 : 0;
  if (calm_ < patience_) return;
  before_trial_ = median(loads_, kRemembered, 1);
  go_to(better);
  trial_ = 1;
}

/// Compares the load of the first frames of a trial with the one before: what has changed at that
/// moment is the preset.
void PresetChooser::learn() {
  const auto judged = static_cast<std::ptrdiff_t>(std::min(trial_ - 1, loads_.size()));
  const double seen =
      median(loads_, static_cast<std::size_t>(judged), before_trial_) / before_trial_;
  const double correction = std::clamp(seen, 1 / kMostCorrection, kMostCorrection);
  for (std::size_t k = preset_; k < cost_ms_.size(); ++k) cost_ms_[k] *= correction;
  for (auto load = loads_.end() - judged; load != loads_.end(); ++load) *load /= correction;
}

void PresetChooser::end_trial(bool kept) {
  if (trial_ <= kRemembered) learn();
  patience_ = kept ? std::max(patience_ / 2, kPatience) : std::min(2 * patience_, kMostPatience);
  trial_ = 0;
}

void PresetChooser::go_to(std::size_t preset) {
  preset_ = preset;
  misses_.clear();
  calm_ = 0;
  unjudged_ = 1;
}

}  // namespace holdfast::server
