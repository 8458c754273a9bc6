#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>

#include "core/denoiser/denoiser.h"

namespace holdfast::server {

/// What the log says of one session's repaired values: at most a line in each kInterval, however
/// many frames bring them. Knows no clock. Every function may be called from any thread.
class RepairLog {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;

  /// Takes the report of a filtered frame. Returns what to log now, if anything: key=value pairs of
  /// the frame, and of all frames with repairs since the last line that no line told of.
  std::optional<std::string> note(const FrameReport& report, TimePoint now);

  static constexpr std::chrono::seconds kInterval{10};

 private:
  std::mutex mutex_;
  std::optional<TimePoint> said_;            ///< when the last line was
  std::uint64_t frames_ = 0;                 ///< with repairs, since then
  std::map<PlaneId, std::uint64_t> values_;  ///< repaired in them
};

}  // namespace holdfast::server
