#pragma once

#include "client/scenes/view.h"
#include "core/frame/plane.h"

namespace holdfast::scenes {

/// The converged result at the same pixel centres as the noisy planes: `composite` and, by the
/// scene's components, `light<k>.visibility`, `glossy` and `indirect` (irradiance / pi).
///
/// `spp` samples of each component a pixel, stratified in the first two dimensions, rounded up to a
/// square (for shadows, of a multiple of 4). Shadows first take 16; the rest is spent where those
/// disagree with each other or with any of the 5 x 5 pixels around, and then the 16 are discarded,
/// so that the choice cannot bias them. Random numbers do not depend on the frame, so a scene at
/// rest has one reference.
PlaneSet render_reference(const View& view, int spp);

}  // namespace holdfast::scenes
