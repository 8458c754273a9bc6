#pragma once

#include <glm/glm.hpp>

#include "client/scenes/light_state.h"
#include "client/scenes/surface.h"

namespace holdfast::scenes {

struct ShadowRay {
  glm::dvec3 direction{0.0};  ///< unit
  double length_m = 0.0;
};

/// The ray from a surface's ray origin to a light sample that was taken at its position.
inline ShadowRay shadow_ray(const Surface& surface, const LightSample& sample) {
  if (sample.distance_m > 1e30) return {sample.direction, sample.distance_m};
  const glm::dvec3 to_light =
      surface.position + sample.direction * sample.distance_m - surface.origin;
  const double length = glm::length(to_light);
  return {length > 0.0 ? to_light / length : sample.direction, length};
}

}  // namespace holdfast::scenes
