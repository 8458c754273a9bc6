#pragma once

#include <gtest/gtest.h>

#include "core/denoiser/rest.h"
#include "tests/core/denoiser_world.h"

namespace holdfast::test {

/// A wall with a strip of sky that stands still, under a light with a penumbra, with reflections
/// and indirect light: noise around known means.
struct RestWorld {
  DenoiserConfig config;
  std::uint32_t seed = 1;

  explicit RestWorld(int rest_turns = 4, int width = 48, int height = 32)
      : config(full_config(width, height)) {
    config.lights.pop_back();
    std::erase_if(config.planes, [](PlaneId id) { return id.component.light == 7; });
    config.rest_turns = rest_turns;
  }

  static constexpr int kSky = 3;  ///< rows

  double visibility(int x) const { return (x + 0.5) / config.width; }

  /// `share`: of the light that there is at first.
  Frame frame(std::int64_t index, double share = 1) const {
    Frame frame;
    frame.index = index;
    frame.camera = perspective_camera(config.width, config.height);
    frame.objects[2] = glm::dmat4(1);
    frame.lights[0] = glm::translate(glm::dmat4(1), {-0.3, 0.5, -1.0});
    Random random(seed * 7919u + static_cast<std::uint32_t>(index));
    for (const PlaneId id : config.planes) fill(frame.planes, id, share, random);
    return frame;
  }

  void fill(PlaneSet& planes, PlaneId id, double share, Random& random) const {
    Plane& plane = planes.add(id, config.width, config.height);
    for (int y = 0; y < config.height; ++y)
      for (int x = 0; x < config.width; ++x) {
        if (plane.is_uint()) {
          plane.ids().at(x, y) = 1;
          continue;
        }
        const double sample = random.uniform();
        for (int c = 0; c < plane.channels(); ++c)
          plane.channel(c).at(x, y) = static_cast<float>(value(id.kind, x, y, c, share, sample));
      }
  }

  double value(PlaneKind kind, int x, int y, int c, double share, double sample) const {
    switch (kind) {
      case PlaneKind::kDepth: return y < kSky ? HUGE_VAL : 5;
      case PlaneKind::kNormal: return c == 2 ? 1 : 0;
      case PlaneKind::kVisibility: return sample < share * visibility(x) ? 1 : 0;
      case PlaneKind::kBlockerDistance: return sample < 0.5 ? 0.5 + sample : HUGE_VAL;
      case PlaneKind::kGlossy: return 2 * share * sample;
      case PlaneKind::kIndirect: return share * (0.5 + sample);
      default: return 0.5;
    }
  }

  /// RMSE of a component's plane over the wall.
  double error(const PlaneSet& results, PlaneId id) const {
    double sum = 0;
    for (int y = kSky; y < config.height; ++y)
      for (int x = 0; x < config.width; ++x) {
        const double truth = id.kind == PlaneKind::kVisibility ? visibility(x) : 1;
        const double e = double{results.at(id).channel(0).at(x, y)} - truth;
        sum += e * e;
      }
    return std::sqrt(sum / (config.width * (config.height - kSky)));
  }
};

/// Frames after which all components of a scene at rest take turns.
inline constexpr int kAtRest = RestTurns::kSettling + 2;

/// A session that has come to rest: the next frame to filter is `next`.
struct RestingSession {
  RestWorld world;
  Denoiser denoiser;
  PlaneSet results;
  std::int64_t next = 0;
  FrameReport report;

  explicit RestingSession(const RestWorld& of = RestWorld()) : world(of), denoiser(of.config) {
    while (next < kAtRest) step();
  }
  void step() { filter(world.frame(next)); }
  void filter(const Frame& frame) {
    report = denoiser.filter(frame, results);
    next = frame.index + 1;
  }
};

}  // namespace holdfast::test
