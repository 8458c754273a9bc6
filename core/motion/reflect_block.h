#pragma once

#include <cstdint>

#include "core/motion/follow_block.h"

/// Reflections of a block of pixels, followed to the previous frame at once on the selected
/// instruction set: what glossy_motion.h says of one pixel.
namespace holdfast {

/// Pixels of one object that reflect one object. A pixel without a usable sample (direction (0,0,0)
/// or not finite, negative or NaN distance) is not `found`, nor is one whose image is behind the
/// camera then or, where `relative`, now.
struct ReflectionFollow {
  const BlockPixels& pixels;
  const ObjectMotion<float>&surface, &hit;
  const glm::mat4 &pixel, &previous_pixel;  ///< each view's pixel_from_relative
  const float *direction[3], *hit_m;        ///< of the samples; +inf: sky
  FollowedBlock& out;    ///< x, y: of the image one frame ago; point, normal: of the receiver then
  float *now_x, *now_y;  ///< written: of the image now; null: not asked for
};
void follow_reflection(const ReflectionFollow& block) noexcept;

/// Adds to pixel positions a draw from the region that can reflect to the same hit: N(0, Sigma) of
/// `glossy_spread` along `incidence_axis`, both in the previous frame.
struct ReflectionSpread {
  const glm::mat4& previous_pixel;
  float focal_px;          ///< of the previous frame
  const float* roughness;  ///< perceptual
  const float* hit_m;
  const float *u, *v;         ///< random, in (0, 1), by lane, such as `draw_pairs` makes
  const FollowedBlock& from;  ///< of the receivers and their images
  int count;
  float *x, *y;  ///< written
};
void spread_reflection(const ReflectionSpread& block) noexcept;

/// uniform_pair(key ^ mix_bits(first + i)) for lanes i.
struct PairDraws {
  std::uint64_t key, first;
  int count;
  float *u, *v;  ///< written
};
void draw_pairs(const PairDraws& block) noexcept;

}  // namespace holdfast
