#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace holdfast::server {

/// The threads that encode results with formats and codecs, so that gRPC's threads, which serve all
/// streams, never wait for one. A job is one piece of at most 1 MiB, about 1 to 3 ms; a stream has
/// one job at a time, so that streams take turns.
class Encoders {
 public:
  /// `threads`: at least 1.
  explicit Encoders(int threads);
  /// Runs what was posted, then stops.
  ~Encoders();

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
