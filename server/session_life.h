#pragma once

#include <chrono>
#include <cstdint>

namespace holdfast::server {

/// The states of a session and what leads from one to the other. Knows neither network nor clock:
/// the time is handed in.
///
///   waiting    no stream; ends when it has waited for the linger time
///   streaming  a stream holds it
///
///   waiting   -- attach --> streaming    a new hold
///   streaming -- attach --> streaming    a new hold: the newest stream wins, the older one is void
///   streaming -- detach of the present hold --> waiting, from that time on
///   streaming -- detach of a void hold --> streaming
///   waiting   -- linger time over --> expired: the table forgets the session
///
/// Deletion ends a session in any state.
class SessionLife {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;
  /// Names one stream's hold on the session; never 0.
  using Hold = std::uint64_t;

  explicit SessionLife(TimePoint now) : waiting_since_(now) {}

  Hold attach() {
    streaming_ = true;
    return ++hold_;
  }
  /// False, without effect, if `hold` is void.
  bool detach(Hold hold, TimePoint now) {
    if (!streaming_ || hold != hold_) return false;
    streaming_ = false;
    waiting_since_ = now;
    return true;
  }
  bool streaming() const { return streaming_; }
  bool expired(TimePoint now, std::chrono::milliseconds linger) const {
    return !streaming_ && now - waiting_since_ >= linger;
  }

 private:
  bool streaming_ = false;
  Hold hold_ = 0;
  TimePoint waiting_since_;
};

}  // namespace holdfast::server
