#pragma once

#include "core/history/accumulate.h"
#include "core/history/tap_lanes.h"

/// The inner loops of `accumulate`, for a block of a row's pixels at once on the selected
/// instruction set.
namespace holdfast {

/// What each pixel of a block follows.
struct AccumulationLanes {
  const Taps* taps;     ///< none: no history
  const float* trust;   ///< 0..1, of pixels with taps; null: 1
  const float* effect;  ///< 1 where the effect's vector is followed; null: the surface's everywhere
  bool clamp_surface, clamp_effect;  ///< which history is rectified
};

/// The block of `count` pixels from (x, y) on.
struct AccumulationBlock {
  const Guides& guides;
  const Channels<float>& noisy;
  const ComponentHistory& before;
  const AccumulationRule& rule;
  const AccumulationLanes& lanes;
  int x, y, count;  ///< 1..kTapBlock
  ComponentHistory& now;
  Channels<float>& signal;
  float* history_samples;  ///< kTapBlock: written, N of the formula
  float* history_weight;   ///< kTapBlock: written, 1 - a'
};

/// Blends the block with its history, and the moments of the luminance where they are kept.
void accumulate_block(const AccumulationBlock& block) noexcept;

}  // namespace holdfast
