#pragma once

#include <glm/glm.hpp>

#include "client/scenes/scene.h"
#include "client/scenes/world.h"

namespace holdfast::scenes {

/// A shading point: where it is and what it is made of.
struct Surface {
  glm::dvec3 position{0.0};          ///< world, metres
  glm::dvec3 origin{0.0};            ///< where rays that leave the surface start
  glm::dvec3 normal{0.0};            ///< world, unit, faces the viewer
  glm::dvec3 geometric_normal{0.0};  ///< world, unit, faces the viewer
  glm::dvec3 to_viewer{0.0};         ///< world, unit
  glm::dvec3 albedo{0.0}, specular{0.0}, emission{0.0};
  double roughness = 1.0;

  bool has_lobe() const { return specular != glm::dvec3(0.0); }
};

/// The shading point of a hit of a ray with this unit direction.
Surface surface_at(const Scene& scene, const Hit& hit, const glm::dvec3& direction);

}  // namespace holdfast::scenes
