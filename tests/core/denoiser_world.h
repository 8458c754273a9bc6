#pragma once

#include <vector>

#include <gtest/gtest.h>

#include "core/denoiser/denoiser.h"
#include "tests/core/small_world.h"

namespace holdfast::test {

inline constexpr PlaneId kDepthPlane{PlaneKind::kDepth, {}};
inline constexpr PlaneId kNormalPlane{PlaneKind::kNormal, {}};
inline constexpr PlaneId kIdPlane{PlaneKind::kObjectId, {}};
inline constexpr PlaneId kGlossyPlane{PlaneKind::kGlossy, {}};
inline constexpr PlaneId kIndirectPlane{PlaneKind::kIndirect, {}};
inline constexpr PlaneId kCompositePlane{PlaneKind::kComposite, {}};

inline PlaneId of_light(PlaneKind kind, std::uint32_t light = 0) {
  return PlaneId::of_light(kind, light);
}

/// A session with everything: a light with blockers, one without, glossy and indirect.
inline DenoiserConfig full_config(int width = 37, int height = 29) {
  DenoiserConfig config;
  config.width = width;
  config.height = height;
  config.lights = {{0, LightShape::kRectangle, 1.5, 0.5, 0}, {7, LightShape::kPoint, 0, 0, 0}};
  config.planes = {kDepthPlane,
                   kNormalPlane,
                   kIdPlane,
                   of_light(PlaneKind::kUnshadowed),
                   of_light(PlaneKind::kVisibility),
                   of_light(PlaneKind::kBlockerDistance),
                   of_light(PlaneKind::kBlockerId),
                   of_light(PlaneKind::kLightSample),
                   of_light(PlaneKind::kUnshadowed, 7),
                   of_light(PlaneKind::kVisibility, 7),
                   {PlaneKind::kSpecular, {}},
                   kGlossyPlane,
                   {PlaneKind::kAlbedo, {}},
                   kIndirectPlane,
                   {PlaneKind::kEmission, {}}};
  return config;
}

/// The light's planes for its shadow alone.
inline DenoiserConfig shadow_config(int width = 37, int height = 29) {
  DenoiserConfig config = full_config(width, height);
  config.lights.pop_back();
  config.planes = {kDepthPlane,
                   kNormalPlane,
                   kIdPlane,
                   of_light(PlaneKind::kVisibility),
                   of_light(PlaneKind::kBlockerDistance),
                   of_light(PlaneKind::kLightSample)};
  return config;
}

/// A wall with a strip of sky and a nearer moving box, under a camera and lights that move: noise
/// that follows from (seed, index) alone.
inline Frame noisy_frame(const DenoiserConfig& config, std::int64_t index, std::uint32_t seed = 1) {
  const int width = config.width, height = config.height;
  const auto t = static_cast<double>(index);
  Frame frame;
  frame.index = index;
  frame.camera = perspective_camera(width, height, {0.02 * t, 0.01 * t, 0});
  frame.objects[2] = glm::translate(glm::dmat4(1), {0.05 * t, 0, 0});
  for (const Light& light : config.lights)
    frame.lights[light.id] = glm::translate(glm::dmat4(1), {0.1 * t - 0.3, 0.5, -1.0});
  Random random(seed * 1000u + static_cast<std::uint32_t>(index));
  for (const PlaneId id : config.planes) {
    Plane& plane = frame.planes.add(id, width, height);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const bool box = x > width / 3 && x < width / 2 && y > height / 3;
        const bool sky = y < 3;
        if (plane.is_uint()) {
          plane.ids().at(x, y) = id.kind == PlaneKind::kBlockerId || box ? 2 : 1;
          continue;
        }
        for (int c = 0; c < plane.channels(); ++c) {
          float value = random.real();
          if (id.kind == PlaneKind::kDepth) value = sky ? kInf : (box ? 3.0f : 5.0f);
          if (id.kind == PlaneKind::kNormal) value = c == 2 ? 1.0f : 0.0f;
          if (id.kind == PlaneKind::kVisibility) value = value < 0.5f ? 0.0f : 1.0f;
          if (id.kind == PlaneKind::kBlockerDistance) value = value < 0.5f ? 0.5f + value : kInf;
          plane.channel(c).at(x, y) = value;
        }
      }
  }
  return frame;
}

inline PlaneSet filtered(Denoiser& denoiser, const Frame& frame) {
  PlaneSet results;
  denoiser.filter(frame, results);
  return results;
}

/// The largest difference between the same planes of two sets; infinite where one is not finite.
inline double largest_difference(const PlaneSet& a, const PlaneSet& b) {
  double worst = 0;
  for (const Plane& plane : a)
    for (int c = 0; c < plane.channels(); ++c)
      for (int y = 0; y < plane.height(); ++y)
        for (int x = 0; x < plane.width(); ++x) {
          const double difference = std::abs(double(plane.channel(c).at(x, y)) -
                                             double(b.at(plane.id()).channel(c).at(x, y)));
          worst = difference <= worst ? worst : (std::isnan(difference) ? HUGE_VAL : difference);
        }
  return worst;
}

/// True if both sets hold the same planes with the same bits.
inline testing::AssertionResult same_bits(const PlaneSet& a, const PlaneSet& b) {
  if (a.size() != b.size()) return testing::AssertionFailure() << a.size() << " and " << b.size();
  for (const Plane& plane : a)
    for (int c = 0; c < plane.channels(); ++c)
      for (int y = 0; y < plane.height(); ++y)
        for (int x = 0; x < plane.width(); ++x)
          if (plane.words(c).at(x, y) != b.at(plane.id()).words(c).at(x, y))
            return testing::AssertionFailure()
                   << plane_name(plane.id()) << " differs at " << x << ", " << y;
  return testing::AssertionSuccess();
}

}  // namespace holdfast::test
