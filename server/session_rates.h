#pragma once

#include <algorithm>
#include <mutex>

#include "server/config.h"
#include "server/token_bucket.h"

namespace holdfast::server {

/// How fast one session may send. It outlives the session's streams, so that a client gains nothing
/// by connecting again. Over the limit its stream is not read, which stops the client through the
/// windows of HTTP/2; nothing is lost. Every function may be called from any thread.
class SessionRates {
 public:
  using TimePoint = TokenBucket::TimePoint;
  using Duration = TokenBucket::Duration;

  /// `told`: frames a second that the client has told; 0 = none.
  SessionRates(const SessionLimits& limits, double told, TimePoint now)
      : frames_(rate_of(limits, told), burst_of(limits, told), now),
        bytes_(static_cast<double>(limits.max_bytes_per_second),
               kBurstSeconds * static_cast<double>(limits.max_bytes_per_second), now) {}

  /// How long a frame that wants to begin has to wait; where that is 0 the frame is counted.
  Duration admit_frame(TimePoint now) {
    const std::lock_guard lock(mutex_);
    const Duration wait = frames_.wait(1, now);
    if (wait == Duration::zero()) frames_.take(1, now);
    return wait;
  }
  /// Counts bytes that have been read; how long nothing more may be read.
  Duration count_bytes(std::size_t bytes, TimePoint now) {
    const std::lock_guard lock(mutex_);
    bytes_.take(static_cast<double>(bytes), now);
    return bytes_.wait(0, now);
  }

 private:
  static constexpr double kBurstSeconds = 0.25;  // ours: jitter of a network passes, a flood not
  static constexpr double kDrift = 1.05;         // clocks differ, and a rate is told roughly
  static constexpr double kBurstFrames = 8;      // as warm a new server

  static double rate_of(const SessionLimits& limits, double told) {
    if (told <= 0) return limits.max_frames_per_second;
    return limits.max_frames_per_second > 0 ? std::min(limits.max_frames_per_second, kDrift * told)
                                            : kDrift * told;
  }
  static double burst_of(const SessionLimits& limits, double told) {
    const double burst = kBurstSeconds * rate_of(limits, told);
    return told > 0 ? std::max(burst, kBurstFrames) : burst;
  }

  std::mutex mutex_;
  TokenBucket frames_, bytes_;
};

}  // namespace holdfast::server
