#pragma once

#include "core/frame/scene_motion.h"

namespace holdfast {

/// Where the surface point of a pixel was one frame ago: x_{i-1} = P_{i-1}(T_s^{-1} s_i).
/// `point` is relative to the current camera, metres; the result is a pixel position and depth of
/// the previous frame. Source: method of temporal reprojection, Nehab et al. 2007.
template <class T>
PixelPoint<T> surface_previous_pixel(const ObjectMotion<T>& motion, const glm::vec<3, T>& point) {
  return project(motion.prev_pixel, point);
}

}  // namespace holdfast
