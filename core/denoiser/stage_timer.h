#pragma once

#include <chrono>
#include <ctime>
#include <string>
#include <utility>
#include <vector>

#include "core/denoiser/denoiser.h"

namespace holdfast {

/// Times the stages of a frame: each call of `end` names the stage that has just ended.
class StageTimer {
 public:
  explicit StageTimer(std::vector<StageTime>& out) : out_(out), last_(Clock::now()) {}

  /// Names of stages begin with "COMPONENT." from here on; with nothing, if it is empty.
  void enter(const std::string& component) { prefix_ = component.empty() ? "" : component + "."; }

  /// Images are that much smaller than the frame from here on: 0.25 at half resolution, 1 at its
  /// own.
  void size_images(double share) { share_ = share; }

  /// `channels_moved`: images of one float that the stage's passes read or write, each once a pass;
  /// what must go through memory at least if caches keep nothing from pass to pass.
  void end(const char* stage, int channels_moved) {
    const auto now = Clock::now();
    const double thread_now_ms = thread_ms();
    out_.push_back({prefix_ + stage, std::chrono::duration<double, std::milli>(now - last_).count(),
                    4.0 * share_ * channels_moved, thread_now_ms - last_thread_ms_});
    last_ = now;
    last_thread_ms_ = thread_now_ms;
  }

 private:
  using Clock = std::chrono::steady_clock;

  static double thread_ms() {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
  }

  std::vector<StageTime>& out_;
  std::string prefix_;
  double share_ = 1;
  Clock::time_point last_;
  double last_thread_ms_ = thread_ms();
};

}  // namespace holdfast
