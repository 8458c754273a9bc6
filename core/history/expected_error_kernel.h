#pragma once

#include "core/history/expected_error.h"
#include "core/history/tap_lanes.h"

/// The inner loops of `blend_by_expected_error`, for a block of a row's pixels at once on the
/// selected instruction set.
namespace holdfast {

/// Reads a candidate: its values, its samples and its differences to the frame. Without taps the
/// value is the frame's and the samples are 0. Rows of `count` pixels, 1..kTapBlock.
struct VisibilityCandidate {
  const Taps* taps;
  int count;
  const ComponentHistory& before;
  const float* noisy;
  float *value, *difference, *samples;  ///< written
};
void read_visibility(const VisibilityCandidate& block) noexcept;

/// Chooses the candidate of each pixel and blends. Candidates: the surface's, the shadow's.
struct VisibilityBlend {
  int count;
  const ExpectedErrorRule& rule;
  const float *noisy, *variance, *spread;
  const float *value[2], *samples[2], *bias[2];
  const float *shadow_motion[2], *surface_motion[2], *sweep;  ///< of the shadow; all null: none
  float *out, *out_samples;                                   ///< written
  float *chosen, *history, *weight;  ///< kTapBlock: index, its samples (0: none), 1 - alpha
};
void blend_visibility(const VisibilityBlend& block) noexcept;

}  // namespace holdfast
