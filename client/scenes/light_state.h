#pragma once

#include <vector>

#include <glm/glm.hpp>

#include "client/scenes/scene.h"

namespace holdfast::scenes {

/// A light at one time.
struct LightState {
  Light light;
  glm::dvec3 emission{0.0};  ///< zero while it is off
  glm::dmat4 world_from_light{1.0};

  bool is_on() const { return emission != glm::dvec3(0.0); }
  /// True if every sample (u, v) is the same place or direction.
  bool is_delta() const;
};

/// All lights of a scene at a time in frames.
std::vector<LightState> lights_at(const Scene& scene, double frame);

/// One sample of a light as a shading point sees it.
struct LightSample {
  glm::dvec3 direction{0.0};  ///< unit, from the point to the light
  double distance_m = 0.0;    ///< +inf for directional lights
  double geometry = 0.0;      ///< irradiance of a facing surface per unit emission and unit (u, v)
};

/// The sample (u, v) of `light_point` seen from `point` (world, metres). Geometry is 0 where the
/// light faces away.
LightSample sample_light(const LightState& light, const glm::dvec3& point, const glm::dvec2& uv);

/// A sample of the light for an estimate of the irradiance at `point`: as `sample_light`, but near
/// a rectangle `uv` in [0,1]^2 is uniform in solid angle, and geometry is that angle. It stays
/// bounded where area over distance squared grows without limit.
LightSample sample_irradiance_of(const LightState& light, const glm::dvec3& point,
                                 const glm::dvec2& uv);

}  // namespace holdfast::scenes
