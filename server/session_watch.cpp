#include "server/session_watch.h"

#include <algorithm>
#include <cmath>

namespace holdfast::server {
namespace {

constexpr std::size_t kMostSent =
    5000;  // answers a second that the rate can tell times kRateSeconds

double ms(std::chrono::steady_clock::duration time) {
  return std::chrono::duration<double, std::milli>(time).count();
}

/// The smallest value that `fraction` of the values do not exceed; the values are reordered.
double percentile(std::vector<double>& values, double fraction) {
  if (values.empty()) return 0;
  const double rank = std::ceil(fraction * static_cast<double>(values.size()));
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(std::max(rank, 1.0)) - 1;
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace

void SessionWatch::sent(const FrameSlot& slot, const std::string& preset, TimePoint now) {
  const std::lock_guard lock(mutex_);
  ++counts_.frames;
  sent_.push_back(now);
  if (sent_.size() > kMostSent) sent_.pop_front();
  if (slot.error) {
    ++counts_.errors;
    return;
  }
  if (slot.repeated) ++counts_.repeated;
  if (slot.answer->dropped) ++counts_.dropped;
  if (slot.repeated || slot.answer->dropped) return;
  const FrameReport& report = slot.answer->report;
  for (const RepairCount& repair : report.repaired) counts_.repaired += repair.values;
  counts_.preset = preset;
  counts_.history_frames = report.mean_history_frames;
  times_.push_back({ms(slot.ended - slot.begun), ms(slot.decode), ms(slot.started - slot.ended),
                    report.ms, ms(slot.encode), ms(now - slot.answered), ms(now - slot.begun)});
  if (times_.size() > kWindow) times_.pop_front();
}

double SessionWatch::core_ms() const {
  constexpr std::size_t kFilter = 3;  // of kWatchedStages
  const std::lock_guard lock(mutex_);
  if (times_.size() < kJudged) return 0;
  std::vector<double> values;
  for (auto it = times_.rbegin(); values.size() < kJudged; ++it) values.push_back((*it)[kFilter]);
  return percentile(values, 0.5);
}

SessionWatch::Glance SessionWatch::glance(TimePoint now) const {
  const std::lock_guard lock(mutex_);
  Glance out = counts_;
  const auto recent = std::count_if(sent_.begin(), sent_.end(), [&](TimePoint time) {
    return std::chrono::duration<double>(now - time).count() < kRateSeconds;
  });
  // Of a session that is younger than the span, over its life.
  const double age = sent_.empty() ? 0 : std::chrono::duration<double>(now - sent_.front()).count();
  if (recent > 1)
    out.frames_per_second = static_cast<double>(recent) / std::clamp(age, 0.5, kRateSeconds);
  std::vector<double> values;
  for (std::size_t stage = 0; stage < kWatchedStages.size(); ++stage) {
    values.clear();
    for (const Times& times : times_) values.push_back(times[stage]);
    out.p50[stage] = percentile(values, 0.50);
    out.p95[stage] = percentile(values, 0.95);
  }
  return out;
}

}  // namespace holdfast::server
