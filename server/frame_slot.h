#pragma once

#include <chrono>
#include <optional>

#include "core/denoiser/denoiser.h"
#include "holdfast/v1/error.pb.h"

namespace holdfast::server {

/// One frame in flight, from its FrameBegin until its last result is sent. Slots are reused, so
/// that their planes are allocated once.
struct FrameSlot {
  using TimePoint = std::chrono::steady_clock::time_point;

  Frame frame;
  PlaneSet results;
  FrameReport report;
  std::optional<v1::FrameError> error;  ///< then there are no results
  TimePoint begun, ended, started;      ///< FrameBegin, FrameEnd, start of filtering
};

}  // namespace holdfast::server
