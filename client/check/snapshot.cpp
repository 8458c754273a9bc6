#include "client/check/snapshot.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace holdfast::check {
namespace {

constexpr std::size_t kStations = 4;
constexpr std::size_t kFarStep = 3;  // frames
constexpr double kSamples = 8000;    // of a frame

}  // namespace

Snapshot Tracker::take(Frame frame) {
  for (const auto& [id, matrix] : frame.objects) objects_[id] = matrix;
  for (const auto& [id, matrix] : frame.lights) lights_[id] = matrix;
  if (frame.cut) ++run_;
  return {frame.index, run_, frame.camera, objects_, lights_, std::move(frame.planes)};
}

std::vector<Station> choose_stations(std::size_t frames) {
  std::vector<Station> stations;
  if (frames < 2) return stations;
  const std::size_t last = frames - 1, count = std::min(kStations, last);
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t now = last - k * (last - 1) / std::max<std::size_t>(count - 1, 1);
    stations.push_back({now - std::min(now, kFarStep), now - 1, now});
  }
  return stations;
}

std::vector<Pair> near_pairs(const Snapshots& frames, const std::vector<Station>& stations) {
  std::vector<Pair> pairs;
  for (const Station& station : stations) {
    const Snapshot &before = frames.at(station.near), &now = frames.at(station.now);
    if (before.run == now.run) pairs.push_back({&before, &now});
  }
  return pairs;
}

std::vector<Pair> far_pairs(const Snapshots& frames, const std::vector<Station>& stations) {
  std::vector<Pair> pairs;
  for (const Station& station : stations) {
    const Snapshot &far = frames.at(station.far), &near = frames.at(station.near);
    const Snapshot& now = frames.at(station.now);
    if (far.run == now.run)
      pairs.push_back({&far, &now});
    else if (near.run == now.run)
      pairs.push_back({&near, &now});
  }
  return pairs;
}

int sample_step(int width, int height) {
  return std::max(1, static_cast<int>(std::ceil(std::sqrt(width * double(height) / kSamples))));
}

}  // namespace holdfast::check
