#include "server/session.h"

#include "core/frame/error.h"
#include "proto/plane_bytes.h"

namespace holdfast::server {

Session::Session(std::string id, std::string token, SessionConfig config)
    : id_(std::move(id)),
      token_(std::move(token)),
      config_(std::move(config)),
      denoiser_(config_.denoiser) {}

FrameReport Session::filter(const Frame& frame, PlaneSet& results) {
  try {
    FrameReport report = denoiser_.filter(frame, results);
    const std::lock_guard lock(mutex_);
    counters_.last_frame = frame.index;
    ++counters_.frames;
    return report;
  } catch (const InputError&) {
    count_error();
    throw;
  } catch (...) {
    denoiser_.reset();
    count_error();
    throw;
  }
}

void Session::count_error() {
  const std::lock_guard lock(mutex_);
  ++counters_.frame_errors;
}

SessionCounters Session::counters() const {
  const std::lock_guard lock(mutex_);
  return counters_;
}

std::size_t frame_bytes(const DenoiserConfig& config) {
  std::size_t bytes = 0;
  const auto add = [&](PlaneId id) {
    bytes += wire::plane_bytes(id, plane_size(id, config.width, config.height));
  };
  for (const PlaneId id : config.planes) add(id);
  for (const PlaneId id : result_planes(config)) add(id);
  return bytes;
}

}  // namespace holdfast::server
