#pragma once

#include <span>

#include "core/denoiser/plan.h"
#include "core/frame/frame.h"
#include "core/oracle/frame_view.h"

namespace holdfast::oracle {

/// Unshadowed light of one light from its radiance and the material planes, see
/// denoiser/light_shading.h. Three channels, 0 on sky.
Image shade(const Surfaces& now, const Light& light, const LightPlaces& places, bool with_lobe,
            const PlaneSet& planes);

/// A filtered component and what it is multiplied by.
struct Term {
  const Image* signal;
  const Plane* given_factor = nullptr;  ///< of the frame
  const Image* own_factor = nullptr;    ///< in place of that; neither: 1
};

/// denoiser/composite.h: the sum of all terms on surfaces, and of emission everywhere.
Image compose(const Surfaces& now, std::span<const Term> terms, const Plane* emission);

}  // namespace holdfast::oracle
