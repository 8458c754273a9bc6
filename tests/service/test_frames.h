#pragma once

#include <cstdint>
#include <memory>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "core/denoiser/denoiser.h"

namespace holdfast::test {

/// A session with one light: the planes that a shadow needs.
inline DenoiserConfig small_config(int width = 37, int height = 21) {
  DenoiserConfig config;
  config.width = width;
  config.height = height;
  config.lights = {{0, LightShape::kRectangle, 1.5, 0.5, 0}};
  config.planes = {{PlaneKind::kDepth, {}},
                   {PlaneKind::kNormal, {}},
                   {PlaneKind::kObjectId, {}},
                   PlaneId::of_light(PlaneKind::kUnshadowed, 0),
                   PlaneId::of_light(PlaneKind::kVisibility, 0)};
  return config;
}

/// A wall that faces a camera which moves sideways; visibility is noise that follows from (seed,
/// index) alone.
inline Frame small_frame(const DenoiserConfig& config, std::int64_t index, std::uint32_t seed = 1) {
  Frame frame;
  frame.index = index;
  const double aspect = static_cast<double>(config.width) / config.height;
  frame.camera.view_from_world =
      glm::translate(glm::dmat4(1.0), {-0.01 * static_cast<double>(index), 0.0, 0.0});
  frame.camera.clip_from_view = glm::perspective(0.8, aspect, 0.1, 100.0);
  frame.lights[0] = glm::translate(glm::dmat4(1.0), {0.0, 0.0, 2.0});
  std::uint32_t state = seed * 747796405u + static_cast<std::uint32_t>(index) * 2891336453u + 1u;
  for (const PlaneId id : config.planes) {
    Plane& plane = frame.planes.add(id, config.width, config.height);
    for (int c = 0; c < plane.channels(); ++c)
      for (int y = 0; y < plane.height(); ++y)
        for (int x = 0; x < plane.width(); ++x) {
          state = state * 1664525u + 1013904223u;
          if (id.kind == PlaneKind::kObjectId)
            plane.ids().at(x, y) = 1;
          else if (id.kind == PlaneKind::kDepth)
            plane.channel(c).at(x, y) = 5.0f;
          else if (id.kind == PlaneKind::kNormal)
            plane.channel(c).at(x, y) = c == 2 ? 1.0f : 0.0f;
          else if (id.kind == PlaneKind::kVisibility)
            plane.channel(c).at(x, y) = state >> 31 ? 1.0f : 0.0f;
          else
            plane.channel(c).at(x, y) = static_cast<float>(state >> 8) * 0x1p-24f;
        }
  }
  return frame;
}

/// True if both sets hold the same planes with the same bits.
inline ::testing::AssertionResult same_bits(const PlaneSet& a, const PlaneSet& b) {
  if (a.size() != b.size())
    return ::testing::AssertionFailure() << a.size() << " planes and " << b.size();
  for (const Plane& plane : a) {
    const Plane* const other = b.find(plane.id());
    if (!other || other->width() != plane.width() || other->height() != plane.height())
      return ::testing::AssertionFailure()
             << plane_name(plane.id()) << " missing or of another size";
    for (int c = 0; c < plane.channels(); ++c)
      for (int y = 0; y < plane.height(); ++y)
        for (int x = 0; x < plane.width(); ++x)
          if (plane.words(c).at(x, y) != other->words(c).at(x, y))
            return ::testing::AssertionFailure() << plane_name(plane.id()) << " differs at channel "
                                                 << c << ", pixel " << x << ", " << y;
  }
  return ::testing::AssertionSuccess();
}

}  // namespace holdfast::test
