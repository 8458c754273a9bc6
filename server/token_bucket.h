#pragma once

#include <algorithm>
#include <chrono>

namespace holdfast::server {

/// A limit on how much may pass in a second. Knows no clock: the time is handed in, and must not go
/// back.
///
///   level(t) = min(burst, level(t0) + rate (t - t0)), full at first
///
/// What passes in any span of time t is at most burst + rate t, and one `take` more where the level
/// may become negative. A rate of 0 is no limit.
class TokenBucket {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;
  using Duration = std::chrono::steady_clock::duration;

  /// `rate`: units a second, >= 0. `burst`: units that may pass at once, at least 1.
  TokenBucket(double rate, double burst, TimePoint now)
      : rate_(rate), burst_(std::max(burst, 1.0)), level_(burst_), at_(now) {}

  /// Takes `amount` out, whether or not it is there: what is too much is owed.
  void take(double amount, TimePoint now) {
    level_ = level(now) - amount;
    at_ = std::max(at_, now);
  }

  /// How long until `amount`, at most the burst, is there; 0 if it is.
  Duration wait(double amount, TimePoint now) const {
    const double missing = std::min(amount, burst_) - level(now);
    if (rate_ <= 0 || missing <= 0) return Duration::zero();
    // Rounded up, so that it is there once the time is over.
    return std::chrono::ceil<Duration>(std::chrono::duration<double>(missing / rate_));
  }

 private:
  double level(TimePoint now) const {
    const double seconds = std::chrono::duration<double>(now - at_).count();
    return std::min(burst_, level_ + rate_ * std::max(seconds, 0.0));
  }

  const double rate_, burst_;
  double level_;
  TimePoint at_;
};

}  // namespace holdfast::server
