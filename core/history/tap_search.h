#pragma once

#include "core/history/taps.h"
#include "core/motion/follow_block.h"

/// The search for taps, for up to kFollowBlock pixels at once on the selected instruction set. What
/// `find_taps` and `find_taps_on_any_surface` say for one pixel, these compute for a block.
namespace holdfast {

/// The receiver of lane i.
inline Receiver receiver_of(const FollowedBlock& block, int i, std::uint32_t id) {
  return {{block.point[0][i], block.point[1][i], block.point[2][i]},
          {block.normal[0][i], block.normal[1][i], block.normal[2][i]},
          id};
}

/// The pixels that are looked for.
struct TapSearch {
  const Guides& previous;
  const FollowedBlock& followed;  ///< where each receiver was, and was seen; none unless `found`
  const std::uint32_t* id;        ///< of the receivers
  int count;                      ///< 1..kFollowBlock
  Taps* taps;                     ///< `count` are written
  /// Perceptual, of the receivers: taps whose mean differs by more than kTapRoughnessTolerance are
  /// left out. Null: roughness does not matter. `previous` has it.
  const float* roughness = nullptr;
  float* any =
      nullptr;  ///< `count` are written: 1 where there are taps, else 0; null: not asked for
};

/// `find_taps` at every place.
void find_block_taps(const TapSearch& search);

/// `find_taps_on_any_surface` at every place; points, normals and ids are not read.
void find_block_taps_on_any_surface(const TapSearch& search);

}  // namespace holdfast
