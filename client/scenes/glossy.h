#pragma once

#include <glm/glm.hpp>

#include "client/scenes/surface.h"

namespace holdfast::scenes {

/// The lobe's BRDF, GGX with Schlick's Fresnel term, towards a unit direction; 0 below the surface.
/// `roughness` is perceptual, 0..1.
glm::dvec3 evaluate_lobe(const Surface& surface, const glm::dvec3& to_light, double roughness);

/// The factor `specular` of the composite: the lobe's directional albedo, noise-free, from the
/// table of core/shading/ltc.h. 0 where the material has no lobe.
glm::dvec3 specular_factor(const Surface& surface);

struct LobeSample {
  glm::dvec3 direction{0.0};  ///< unit; zero where there is no lobe or it points into the surface
  glm::dvec3 weight{0.0};     ///< BRDF * cos / density / specular_factor
};

/// A direction of the lobe from the visible normals (Heitz, JCGT 2018). `u` in [0,1)^2.
LobeSample sample_lobe(const Surface& surface, const glm::dvec2& u);

}  // namespace holdfast::scenes
