#pragma once

#include <chrono>
#include <deque>
#include <memory>
#include <mutex>
#include <vector>

#include <holdfast/client.h>

#include "client/cli/bench_frames.h"
#include "client/cli/load.h"
#include "core/denoiser/denoiser.h"

namespace holdfast::cli {

/// The frames of which every session of a load sends its own copies, again and again.
class LoadFrames {
 public:
  /// Renders or reads them. Throws InputError.
  LoadFrames(const LoadOptions& options, const LoadSize& size);

  const DenoiserConfig& config() const { return config_; }
  /// A copy of the `i`-th frame, with the planes of `config`. Called from any thread.
  Frame copy(int i);

 private:
  std::mutex mutex_;  ///< of source_
  BenchFrames source_;
  DenoiserConfig config_;
};

/// One session of a load: sends frames at its rate on one thread and takes answers on another.
class LoadSession {
 public:
  /// Makes the session. Throws as client::Session.
  LoadSession(const LoadOptions& options, const std::string& address, LoadFrames& frames);

  /// When a session sends.
  struct Span {
    std::chrono::steady_clock::time_point load_start;  ///< of the whole load
    std::chrono::steady_clock::time_point start;
    double seconds = 0;
    double phase = 0;  ///< 0..1, of a period, by which it begins later
  };
  /// Sends for that span, and waits for all answers.
  void run(const Span& span);
  const LoadResult& result() const { return result_; }

 private:
  using Clock = std::chrono::steady_clock;

  void send(const Span& span);
  bool overtaken(Clock::time_point due, std::chrono::duration<double> period);
  void take(const client::FrameOutput& output);
  void count_error(const char* kind);

  const LoadOptions& options_;
  client::Session session_;
  std::vector<std::shared_ptr<Frame>> ring_;  ///< one more than may be in flight
  Clock::time_point load_start_;
  std::mutex mutex_;              ///< of what follows
  std::deque<double> client_ms_;  ///< of the frames in flight, in order
  LoadResult result_;
};

}  // namespace holdfast::cli
