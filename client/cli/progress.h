#pragma once

#include <chrono>
#include <string>

namespace holdfast::cli {

/// Progress on standard error: a bar with rate and ETA on a terminal, a plain line now and then
/// otherwise, nothing when quiet.
class Progress {
 public:
  Progress(std::string label, std::int64_t total, bool quiet);
  ~Progress();
  /// `done` of `total` steps are finished. Call from one thread.
  void update(std::int64_t done);
  /// Ends the line; later updates are ignored.
  void finish();

 private:
  void print(std::int64_t done, bool last);

  using Clock = std::chrono::steady_clock;
  std::string label_;
  std::int64_t total_, done_ = 0;
  bool silent_, terminal_;
  Clock::time_point start_, printed_{};
};

}  // namespace holdfast::cli
