#pragma once

#include "client/scenes/gradient_frame.h"
#include "client/scenes/view.h"
#include "core/frame/plane.h"

namespace holdfast::scenes {

/// All planes that the scene's components ask for, with `spp` samples a pixel.
///
/// written always: depth, normal, objectId; emission where anything glows
/// visibility:     light<k>.unshadowed, .visibility, .blockerDistance, .blockerId, .sampleU/V
/// glossy:         roughness, specular, glossy, glossy.direction, .hitDistance, .hitId
/// indirect:       albedo, indirect, indirect.direction
/// Sky: depth +inf, visibility 1, every other value 0 but emission, the sky's radiance.
///
/// With more than one sample, visibility and radiance are means; the blocker is that of the first
/// blocked sample, and directions and hits are those of the first sample.
///
/// `gradients`, if given, gets what its pixels show and their first samples.
PlaneSet render_noisy(const View& view, int spp, GradientSamples* gradients = nullptr);

}  // namespace holdfast::scenes
