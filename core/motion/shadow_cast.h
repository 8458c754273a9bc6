#pragma once

#include <glm/glm.hpp>

#include "core/motion/follow_block.h"

/// How the blocked samples of a block of pixels cast their light's shape, on the selected
/// instruction set: the maths of ShadowTracer::measure.
namespace holdfast {

struct ShadowCast {
  const BlockPixels& pixels;
  const float* distance;  ///< blocker distances, metres; negative or not finite: not blocked
  const float* light[3];  ///< light samples relative to the camera; directions for light_w 0
  float light_w;
  const glm::mat3& half_axes;           ///< of the light, relative to the camera, metres
  int axes;                             ///< how many of them are not zero: the first 2, or all 3
  const glm::mat4& pixel;               ///< the view's pixel_from_relative
  float pixel_y;                        ///< of the row's centre
  float cast_variance;                  ///< of a uniform shape, times half axis^2
  float pixel_variance;                 ///< px^2, added
  float *valid, *ratio, *precision[3];  ///< the channels of a shadow field
};
void cast_shadows(const ShadowCast& block) noexcept;

}  // namespace holdfast
