#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <mutex>
#include <string>
#include <vector>

#include "server/frame_slot.h"
#include "server/preview.h"
#include "server/repair_log.h"

namespace holdfast::server {

/// The stages of a frame in the server, in the order of their beginnings; decode is a part of
/// receive, encode of send, and total goes from FrameBegin to the last result.
inline constexpr std::array<const char*, 7> kWatchedStages{"receive", "decode", "wait", "filter",
                                                           "encode",  "send",   "total"};

/// How one session fares, as the live page shows it: counts since it was made, rates and times of
/// its last frames. Every function may be called from any thread.
class SessionWatch {
 public:
  using TimePoint = FrameSlot::TimePoint;
  using Times = std::array<double, kWatchedStages.size()>;  ///< milliseconds

  /// `ordinal`: 1 for the first session of the server; names it where its id must not be shown.
  explicit SessionWatch(int ordinal) : ordinal_(ordinal) {}

  /// An answer has been sent; `preset` is the one it names.
  void sent(const FrameSlot& slot, const std::string& preset, TimePoint now);

  struct Glance {
    std::uint64_t frames = 0, dropped = 0, repeated = 0, errors = 0;  ///< answered, by kind
    std::uint64_t repaired = 0;    ///< input values that were not finite or out of range
    std::string preset;            ///< of the last filtered frame; empty before it
    double history_frames = 0;     ///< mean history length of that frame
    double frames_per_second = 0;  ///< answered, over the last kRateSeconds
    Times p50{}, p95{};            ///< of the last filtered frames, at most kWindow
  };
  Glance glance(TimePoint now) const;
  /// Median time in the core of the last kJudged filtered frames, milliseconds; 0 before there are
  /// as many.
  double core_ms() const;
  int ordinal() const { return ordinal_; }
  PreviewBox& preview() { return preview_; }
  RepairLog& repairs() { return repairs_; }

  static constexpr std::size_t kWindow = 240;  ///< frames: four seconds of a fast game
  static constexpr std::size_t kJudged = 32;
  static constexpr double kRateSeconds = 5;

 private:
  const int ordinal_;
  PreviewBox preview_;
  RepairLog repairs_;
  mutable std::mutex mutex_;
  Glance counts_;               ///< without what follows from the two below
  std::deque<Times> times_;     ///< oldest first
  std::deque<TimePoint> sent_;  ///< not older than kRateSeconds, at most kMostSent
};

}  // namespace holdfast::server
