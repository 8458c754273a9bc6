#pragma once

#include "core/oracle/surfaces.h"

namespace holdfast::oracle {

/// What the neighbourhood of each pixel says, by means over 9x9 pixels of its surface.
struct Statistics {
  Image variance;      ///< of the luminance of one sample, floored
  Image footprint;     ///< E, F, G of the effect, px^-2, 0 where unknown; empty without a field
  Image valid, ratio;  ///< means of the field's channels; empty without a field
};

/// `field`: channels of core/motion/effect_field.h, of each pixel's own sample; may be empty.
Statistics measure(const Surfaces& now, const Image& noisy, const Image& field);

}  // namespace holdfast::oracle
