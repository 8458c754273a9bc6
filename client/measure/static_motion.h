#pragma once

#include "client/measure/image.h"
#include "core/frame/scene_motion.h"

namespace holdfast::measure {

/// Motion of each pixel's surface since the frame before, pixels, two channels.
struct StaticMotion {
  Image given;    ///< the plane `motion` or, without it, that of the matrices of objects and camera
  Image at_rest;  ///< what it would be if only the camera had moved
  Mask shown;     ///< 1 where there is a surface that was in front of the earlier camera
};

/// `scene` has taken `frame`, and the one before it.
StaticMotion static_motion(const Frame& frame, const SceneMotion& scene);

/// given - at_rest.
Image motion_difference(const StaticMotion& motion);

}  // namespace holdfast::measure
