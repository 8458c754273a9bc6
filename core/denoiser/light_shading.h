#pragma once

#include <vector>

#include "core/denoiser/plan.h"
#include "core/frame/guides.h"
#include "core/frame/light.h"
#include "core/frame/plane.h"
#include "core/frame/scene_motion.h"

namespace holdfast {

/// Fills the unshadowed planes of `plan.shaded_lights` in `out` (there already, of the frame's
/// size) from the lights' radiance and the frame's material planes, see `unshadowed_light`.
///
///   reads   depth, normal, albedo; specular and roughness where the session has both
///   writes  light<k>.unshadowed, 0 on sky
///   halo    none      state   none
///
/// The plane `specular`, the factor of `glossy`, is the lobe's directional albedo; without it, or
/// without roughness, light is diffuse alone. A material value that is not finite or negative
/// counts as 0, and as 1 above 1.
void shade_lights(const Guides& guides, const SceneMotion& scene, const std::vector<Light>& lights,
                  const Plan& plan, const PlaneSet& planes, PlaneSet& out);

}  // namespace holdfast
