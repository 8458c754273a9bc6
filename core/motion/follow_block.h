#pragma once

#include "core/frame/guides.h"
#include "core/frame/scene_motion.h"

/// Surfaces and shadows of up to kFollowBlock neighbouring pixels of a row, followed to the
/// previous frame at once on the selected instruction set. What `surface_previous_pixel` and
/// `shadow_previous_point` say for one pixel, these compute for a block on one object.
namespace holdfast {

inline constexpr int kFollowBlock = 64;  ///< pixels
/// Sweep of a blocker of which nobody knows where it was: nothing that was seen before is expected.
inline constexpr float kUnknownSweep = 1e6f;
/// Of one that has appeared: what was seen before it is known to be wrong.
inline constexpr float kAppearedSweep = 1e12f;

/// The pixels of a block: where they lie, and their surfaces.
struct BlockPixels {
  const float *depth, *normal[3];  ///< of the first pixel; without surface, results are unspecified
  float first_x;                   ///< pixel position of the first one's centre
  int count;                       ///< 1..kFollowBlock
  /// Position at depth d: (near_weight + far_weight d) (base + x across) + d forward.
  float base[3], across[3], forward[3], near_weight, far_weight;

  BlockPixels(const Guides& guides, int x, int y, int pixels);
};

/// What is found: the receivers as they were, and where they or their shadows were seen.
struct FollowedBlock {
  float x[kFollowBlock], y[kFollowBlock];  ///< previous pixel position; 0 unless `found`
  float found[kFollowBlock];               ///< 1 where there is one, in front of the camera; else 0
  float point[3][kFollowBlock];            ///< relative to the previous camera, metres
  float normal[3][kFollowBlock];           ///< unit, previous frame
  float sweep[kFollowBlock];  ///< shadows: how far the blocker moves before the light, in widths of
                              ///< it
};

/// Copies lane i to lane k, but for the sweep.
inline void copy_lane(const FollowedBlock& from, int i, FollowedBlock& to, int k) {
  to.x[k] = from.x[i];
  to.y[k] = from.y[i];
  to.found[k] = from.found[i];
  for (int axis = 0; axis < 3; ++axis) {
    to.point[axis][k] = from.point[axis][i];
    to.normal[axis][k] = from.normal[axis][i];
  }
}

/// x_{i-1} = P_{i-1}(T_s^{-1} s_i) for pixels of one object.
struct SurfaceFollow {
  const BlockPixels& pixels;
  const ObjectMotion<float>& object;
  FollowedBlock& out;
};
void follow_surface(const SurfaceFollow& block) noexcept;

/// The shadow vectors of pixels of one object, shadowed by one object. The blocker of a pixel lies
/// at `ratio` of the way to its light sample. Lights are relative to the current and the previous
/// camera: places for light_w 1, directions towards the light for light_w 0.
struct ShadowFollow {
  const BlockPixels& pixels;
  const ObjectMotion<float>&surface, &occluder;
  const glm::mat4& previous_pixel;  ///< previous view's pixel_from_relative
  const float* ratio;
  const float *light[3], *previous_light[3];
  float light_w;
  const glm::mat3& previous_half_axes;  ///< of the light, metres; columns of zero: no extent
  FollowedBlock& out;
};
void follow_shadow(const ShadowFollow& block) noexcept;

}  // namespace holdfast
