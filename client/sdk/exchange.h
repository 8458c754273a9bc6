#pragma once

#include <chrono>
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <optional>

#include <holdfast/client.h>

#include "core/frame/plane_size.h"

namespace holdfast::client {

/// A frame to be sent. The transforms are what the server has forgotten since the last frame that
/// named them; the frame's own go before them.
struct OutgoingFrame {
  std::shared_ptr<const Frame> frame;
  std::uint64_t epoch = 0;
  TransformTable objects, lights;
  std::shared_ptr<const SessionChange> change =
      nullptr;             ///< whole, no part left out; null: as it was made
  double deadline_ms = 0;  ///< 0 = none
};

/// The frames of a session and their answers, whatever connection carries them: what is to be sent,
/// what waits for its answer, what was answered, and the last answered inputs, with which a new
/// server is warmed. Knows nothing of the network. One mutex guards everything; users call from any
/// thread, one connection at a time calls the rest.
class Exchange {
 public:
  struct Config {
    std::vector<PlaneId> planes;
    int width = 0, height = 0;
    int rewarm_frames = 0;
    double deadline_ms = 0;  ///< of each frame
  };
  explicit Exchange(Config config)
      : config_(std::move(config)), size_{config_.width, config_.height} {}

  // The user's side; see Session.
  bool submit(std::shared_ptr<const Frame> frame, bool wait);
  std::optional<FrameOutput> receive(bool wait);
  void finish();
  void restart();
  void change(const SessionChange& change);
  void recycle(PlaneSet&& planes);
  int credits() const;
  int in_flight() const;
  Traffic traffic() const;
  int reconnects() const;

  // The connection's side.

  /// A stream is open. What is not answered is sent again; `fresh`: by a session without history,
  /// which is warmed first.
  void opened(int credits, bool fresh);
  /// The next frame, if there is one and a credit for it.
  std::optional<OutgoingFrame> next();
  /// True if no frame will follow those that `next` has given.
  bool all_sent() const;
  /// Takes the next answer of this stream. Throws std::runtime_error if it is out of turn.
  void answered(FrameOutput&& output);
  /// Planes for an answer to fill; may be empty.
  PlaneSet spare();
  /// Size of the frame whose answer is the next on this stream. Throws std::runtime_error if none
  /// is due.
  PlaneSize answer_size() const;
  void count(std::uint64_t sent, std::uint64_t received);
  /// Index of the last answered frame, if there is one.
  std::optional<std::int64_t> last_answered() const;
  /// True if there is nothing left to do.
  bool complete() const;
  /// There will be no other stream. Null: in order.
  void close(std::exception_ptr error);
  /// Throws what the exchange was closed with.
  void check_closed() const;

 private:
  using Clock = std::chrono::steady_clock;
  struct Pending {
    std::shared_ptr<const Frame> frame;
    std::uint64_t epoch = 0;
    Clock::time_point submitted;
    std::shared_ptr<const SessionChange> change;
  };
  struct Sent {
    std::int64_t index = 0;
    PlaneSize size;
    bool warming = false;
  };

  // With the mutex held.
  PlaneSize size_of(const Pending& pending) const;
  void remember(const Pending& pending);
  void forget_oldest();

  const Config config_;
  mutable std::mutex mutex_;
  PlaneSize size_;                               ///< of frames that are submitted from now on
  std::shared_ptr<const SessionChange> change_;  ///< theirs
  mutable std::condition_variable changed_;
  std::deque<Pending> pending_;  ///< submitted, not yet answered
  std::size_t unsent_ = 0;       ///< the last of pending_, not given to this stream yet
  std::deque<Pending> warming_;  ///< to be sent before pending_
  std::deque<Sent> sent_;        ///< on this stream, without answer yet
  std::deque<Pending> recent_;   ///< answered, at most rewarm_frames
  std::uint64_t recent_epoch_ = 0;
  TransformTable old_objects_, old_lights_;  ///< of the frames before recent_
  bool history_lost_ = false;                ///< to be told with the next answer
  bool first_of_fresh_ = false;              ///< the next frame brings the old transforms
  std::deque<FrameOutput> outputs_;
  std::vector<PlaneSet> spare_;
  Traffic traffic_;
  std::optional<std::int64_t> last_answered_;
  std::uint64_t epoch_ = 0;
  int credits_ = 0, streams_ = 0;
  bool finishing_ = false, closed_ = false;
  std::exception_ptr error_;
};

}  // namespace holdfast::client
