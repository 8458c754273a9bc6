#pragma once

#include <chrono>
#include <condition_variable>
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
  };
  std::deque<Job> jobs_;
  bool ready_ = false;               ///< in the scheduler's line, or running
  std::chrono::nanoseconds used_{};  ///< time that its jobs have taken
};

/// The worker pool that all sessions share. A fixed number of threads filters frames: a few of them
/// lead, each one frame at a time, and the others join the parallel loops of whichever frame has
/// work. The next frame is one of the strand whose jobs have taken the least time, so that sessions
/// share the machine by time, whatever the length of their queues and the size of their frames;
/// those that have taken the same take turns. Among strands that are within kDeadlineSlack of it,
/// the one whose next job has the earliest deadline goes first: who has a deadline may borrow that
/// much time, and no more, from who has none. A strand that had nothing to do saves up no time: it
/// begins level with the strand whose turn it is.
class Scheduler {
 public:
  /// `threads`: all threads that filter, leaders included; 0 = one for each core.
  /// The clock can be replaced in tests.
  using Clock = std::function<std::chrono::steady_clock::time_point()>;
  explicit Scheduler(int threads, Clock clock = std::chrono::steady_clock::now);
  /// Runs what was posted, then stops.
  ~Scheduler();

  /// Adds a job to the end of the strand. Never blocks on jobs; called from any thread. The job
  /// must not throw. `deadline`: by which it should begin.
  void post(const std::shared_ptr<Strand>& strand, std::function<void()> job,
            std::optional<std::chrono::steady_clock::time_point> deadline = {});

  static constexpr std::chrono::milliseconds kDeadlineSlack{20};  ///< about a frame; ours

  int threads() const { return threads_; }
  /// Frames that are filtered at once, at most, by so many `threads`, as of the constructor.
  static int frames_at_once(int threads);

 private:
  void lead();
  std::shared_ptr<Strand> next();

  const Clock clock_;
  int threads_, leaders_;
  std::optional<oneapi::tbb::global_control> more_workers_;
  oneapi::tbb::task_arena arena_;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::deque<std::shared_ptr<Strand>> line_;
  std::chrono::nanoseconds level_{};  ///< time used by the strand whose turn was last
  bool stopping_ = false;
  std::vector<std::thread> pool_;
};

}  // namespace holdfast::server
