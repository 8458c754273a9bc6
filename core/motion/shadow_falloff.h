#pragma once

#include "core/motion/follow_block.h"

namespace holdfast {

/// TRMV's trust in the shadow vectors of a block (`planarity_falloff` of shadow_motion.h): compares
/// the receiver's plane at the place it leads to with the surface that the previous frame shows
/// there. trust[i] is 0 where it shows none.
struct ShadowFalloff {
  const Guides& previous;
  const FollowedBlock& followed;
  int count;     ///< 1..kFollowBlock
  float* trust;  ///< written
};
void shadow_falloff(const ShadowFalloff& block) noexcept;

}  // namespace holdfast
