#pragma once

#include <chrono>
#include <optional>

#include "holdfast/v1/error.pb.h"
#include "server/answer.h"
#include "server/session_config.h"

namespace holdfast::server {

/// One frame in flight, from its FrameBegin until its last result is sent. Slots are reused, so
/// that their planes are allocated once.
struct FrameSlot {
  using TimePoint = std::chrono::steady_clock::time_point;

  Frame frame;
  std::uint64_t epoch = 0;
  std::shared_ptr<const SessionConfig> config;  ///< under which it came
  std::shared_ptr<void> reserved;     ///< memory for a change that it brings, until it is filtered
  std::optional<TimePoint> deadline;  ///< of the begin of filtering
  bool late = false;                  ///< that had passed
  std::shared_ptr<const Answer> answer;  ///< null if there is an error
  bool repeated = false;                 ///< `answer` is that of an earlier time
  std::optional<v1::FrameError> error;
  TimePoint begun, ended, started, answered;    ///< FrameBegin, FrameEnd, filtering
  std::chrono::nanoseconds decode{}, encode{};  ///< inside receiving and sending: bytes <-> planes
};

}  // namespace holdfast::server
