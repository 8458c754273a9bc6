#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace holdfast::server {

/// Threads for work that gRPC's, which serve all streams, would have to wait for. Jobs are taken in
/// the order in which they were posted.
class JobThreads {
 public:
  /// `threads`: at least 1.
  explicit JobThreads(int threads);
  /// Runs what was posted, then stops.
  ~JobThreads();

  /// Adds a job, which must not throw. Never blocks on jobs; called from any thread.
  void post(std::function<void()> job);

 private:
  void work();

  std::mutex mutex_;
  std::condition_variable wake_;
  std::deque<std::function<void()>> jobs_;
  bool stopping_ = false;
  std::vector<std::thread> pool_;
};

}  // namespace holdfast::server
