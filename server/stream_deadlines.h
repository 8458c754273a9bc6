#pragma once

#include <chrono>
#include <optional>

namespace holdfast::server {

/// The times by which a stream must have said something. Knows neither network nor clock: the time
/// is handed in.
///
///   opened  -- Hello ------> idle      within `hello`; a silent stream would hold a place for ever
///   idle    -- FrameBegin -> in frame  no limit: a paused game says nothing
///   in frame -- FrameEnd --> idle      within `frame`; a trickle of bytes would hold a slot for
///   ever
///
/// Time for which the server itself does not read (`pause` .. `resume`) does not count against the
/// frame. A limit of 0 is none.
class StreamDeadlines {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;
  using Duration = std::chrono::steady_clock::duration;

  StreamDeadlines(Duration hello, Duration frame, TimePoint now) : frame_(frame) {
    if (hello > Duration::zero()) due_ = now + hello;
  }

  void greeted() { due_.reset(); }
  void frame_begun(TimePoint now) {
    if (frame_ > Duration::zero()) due_ = now + frame_;
  }
  void frame_ended() { due_.reset(); }
  void pause(TimePoint now) {
    if (!paused_since_) paused_since_ = now;
  }
  void resume(TimePoint now) {
    if (due_ && paused_since_) *due_ += now - *paused_since_;
    paused_since_.reset();
  }

  /// The peer has been silent, or slow, for too long.
  bool passed(TimePoint now) const { return due_ && !paused_since_ && now >= *due_; }

 private:
  const Duration frame_;
  std::optional<TimePoint> due_, paused_since_;
};

}  // namespace holdfast::server
