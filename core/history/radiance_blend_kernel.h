#pragma once

#include "core/history/radiance_blend.h"
#include "core/history/tap_lanes.h"

/// The inner loops of `blend_radiance`, for a block of a row's pixels at once on the selected
/// instruction set.
namespace holdfast {

/// Reads candidate k: its values and samples, and its differences to the frame. Without taps the
/// value is the frame's and the samples are 0.
struct CandidateBlock {
  const Taps* taps;
  int k, x, y, count;  ///< `count` pixels, 1..kTapBlock, from (x, y) on
  const Channels<float>& noisy;
  const ComponentHistory& before;
  RadianceBlendScratch& scratch;
};
void read_candidate(const CandidateBlock& block) noexcept;

/// Chooses the candidate of least expected error for each pixel, and blends.
struct RadianceBlendBlock {
  int candidates, x, y, count;
  const Channels<float>& noisy;
  const RadianceBlendScratch& scratch;
  const float* spread;  ///< 1 / samples of the windows, from x on
  const float* expected[RadianceBlendScratch::kMostCandidates];  ///< LightChange::bias, from x on
  const RadianceBlendRule& rule;
  float threshold;  ///< that of the rule which holds here
  ComponentHistory& now;
  float *chosen, *samples,
      *weight;  ///< kTapBlock: written; index, its samples (0: none), 1 - alpha
};
void blend_candidates(const RadianceBlendBlock& block) noexcept;

}  // namespace holdfast
