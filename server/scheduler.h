#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/task_arena.h>

namespace holdfast::server {

/// Jobs that run one after the other, in the order in which they were posted. One for each session.
class Strand {
 private:
  friend class Scheduler;
  struct Job {
    std::function<void()> run;
    std::optional<std::chrono::steady_clock::time_point> deadline;
    bool newest_first = false;
  };
  std::deque<Job> jobs_;
  bool ready_ = false;               ///< in the scheduler's line, or running
  std::uint64_t newest_ = 0;         ///< number of its newest job among all
  bool fresh_ = false;               ///< in the line since it had nothing to do
  std::chrono::nanoseconds used_{};  ///< time that its jobs have taken
};

/// The worker pool that all sessions share. A fixed number of threads filters frames: a few of them
/// lead, each one frame at a time, and the others join the parallel loops of whichever frame has
/// work. The next frame is one of the strand whose jobs have taken the least time, so that sessions
/// share the machine by time, whatever the length of their queues and the size of their frames;
/// those that have taken the same take turns. A strand that had nothing to do saves up no time: it
/// begins level with the strand whose turn it is.
///
/// Strands that are within kSlack of the least, and no others, may go before it, in this order:
///   the earliest deadline of their next jobs
///   those that had nothing to do before, first come first served: sessions that keep up wait for
///       each other, however their frames differ, and not for those who flood
///   the least time
/// Apart from these stand strands whose next job is `newest_first`: of them the one whose newest
/// job came last goes first. With more jobs than the machine can do, some wait for long in any
/// case; then it is those that nobody wants any more. Of both kinds the one that has used less.
class Scheduler {
 public:
  /// `threads`: all threads that filter, leaders included; 0 = one for each core.
  /// The clock can be replaced in tests.
  using Clock = std::function<std::chrono::steady_clock::time_point()>;
  explicit Scheduler(int threads, Clock clock = std::chrono::steady_clock::now);
  /// Runs what was posted, then stops.
  ~Scheduler();

  /// Adds a job to the end of the strand. Never blocks on jobs; called from any thread. The job
  /// must not throw. `deadline`: by which it should begin. `newest_first`: jobs are worth less the
  /// longer they wait.
  void post(const std::shared_ptr<Strand>& strand, std::function<void()> job,
            std::optional<std::chrono::steady_clock::time_point> deadline = {},
            bool newest_first = false);

  /// A few frames. Ours: with half of it, at twice the load that the machine bears, one in a
  /// hundred answers under newest_first took half as long again.
  static constexpr std::chrono::milliseconds kSlack{40};

  int threads() const { return threads_; }
  /// Frames that are filtered at once, at most, by so many `threads`, as of the constructor.
  static int frames_at_once(int threads);

 private:
  using Line = std::deque<std::shared_ptr<Strand>>;

  void lead();
  std::shared_ptr<Strand> next();
  Line::iterator turn();

  const Clock clock_;
  int threads_, leaders_;
  std::optional<oneapi::tbb::global_control> more_workers_;
  oneapi::tbb::task_arena arena_;
  std::mutex mutex_;
  std::condition_variable wake_;
  Line line_;
  std::uint64_t posted_ = 0;          ///< jobs
  std::chrono::nanoseconds level_{};  ///< time used by the strand whose turn was last
  bool stopping_ = false;
  std::vector<std::thread> pool_;
};

}  // namespace holdfast::server
