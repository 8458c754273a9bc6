#pragma once

#include <chrono>
#include <optional>

namespace holdfast::server {

/// What becomes of a frame whose turn has come. Knows no clock: the time is handed in.
///
///                                  filter                 drop
///   LATE_FRAMES_ALL                always
///   LATE_FRAMES_LATEST             in time and newest     a newer one waits, or its deadline
///   passed
///
/// A deadline is that of the begin of filtering: a result is not worth less for the time that the
/// core takes, which the client knows, but for the wait, which it does not.
struct FrameTurn {
  using TimePoint = std::chrono::steady_clock::time_point;

  bool late = false;  ///< its deadline has passed
  bool drop = false;

  /// `latest`: the session's policy; `newer_waits`: whole, behind this one.
  FrameTurn(TimePoint now, std::optional<TimePoint> deadline, bool latest, bool newer_waits)
      : late(deadline && now > *deadline), drop(latest && (late || newer_waits)) {}
};

}  // namespace holdfast::server
