#pragma once

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
  std::deque<std::function<void()>> jobs_;
  bool ready_ = false;  ///< in the scheduler's ready list, or running
};

/// The worker pool that all sessions share. A fixed number of threads filters frames: a few of them
/// lead, each one frame at a time, and the others join the parallel loops of whichever frame has
/// work. A strand that has run a job goes to the end of the line, so that sessions take turns frame
/// by frame, whatever the length of their queues.
class Scheduler {
 public:
  /// `threads`: all threads that filter, leaders included; 0 = one for each core.
  explicit Scheduler(int threads);
  /// Runs what was posted, then stops.
  ~Scheduler();

  /// Adds a job to the end of the strand. Never blocks on jobs; called from any thread. The job
  /// must not throw.
  void post(const std::shared_ptr<Strand>& strand, std::function<void()> job);

  int threads() const { return threads_; }

 private:
  void lead();

  int threads_, leaders_;
  std::optional<oneapi::tbb::global_control> more_workers_;
  oneapi::tbb::task_arena arena_;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::deque<std::shared_ptr<Strand>> line_;
  bool stopping_ = false;
  std::vector<std::thread> pool_;
};

}  // namespace holdfast::server
