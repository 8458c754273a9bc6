#pragma once

#include "client/scenes/view.h"
#include "core/frame/plane.h"

namespace holdfast::scenes {

/// The converged result at the same pixel centres as the noisy planes: `composite` and, by the
/// scene's components, `light<k>.visibility`, `glossy` and `indirect` (irradiance / pi).
///
/// `spp` samples of each component a pixel; a power of 2 is best. Shadows: stratified, rounded up
/// to a square of a multiple of 4; they first take 16, and the rest is spent where those disagree
/// with each other or with any of the 5 x 5 pixels around, and then the 16 are discarded, so that
/// the choice cannot bias them. Glossy and indirect light: `ReferenceRadiance`. Random numbers do
/// not depend on the frame, so a scene at rest has one reference.
PlaneSet render_reference(const View& view, int spp);

}  // namespace holdfast::scenes
