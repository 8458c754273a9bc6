#pragma once

#include "core/history/tap_lanes.h"
#include "core/radiance/cones.h"

/// The inner loops of ConeHistory, for a block of a row's pixels at once on the selected
/// instruction set.
namespace holdfast {

inline constexpr int kMostConeChannels = 28;

/// Cones of the pixels of a block as channels: sums by colour and cone, samples by cone, and with
/// one colour the chroma R and B. Rows of `count` values.
struct ConeRows {
  int count;    ///< 1..kTapBlock; of `sums_to_means` and back any
  int colours;  ///< 1: luminance, or 3
  float* of[kMostConeChannels];

  float* sum(int colour, int k) const { return of[colour * kCones + k]; }
  float* samples(int k) const { return of[colours * kCones + k]; }
  float* chroma(int c) const { return of[2 * kCones + c]; }
};

/// Recalls what was kept at the taps, as it was; 0 where there are none.
struct ConeRecall {
  const Taps* taps;
  const Channels<float>& kept;
  const Guides& previous;
  const float* normal[3];         ///< of the pixels now
  const ConeRows& rows;           ///< written, all channels of `kept`
  float (&before)[3][kTapBlock];  ///< normals at the taps, not of unit length; 0 without
  std::uint8_t* turned;           ///< 1 where that differs from the normal by kSameConesCosine
};
void recall_cones(const ConeRecall& block) noexcept;

/// Sums of cones into their means, which are 0 without samples, and back. Of equal radiance the
/// means are equal and stay so when they are rounded alike; the sums are not.
void sums_to_means(const ConeRows& rows) noexcept;
void means_to_sums(const ConeRows& rows) noexcept;

/// Corrects samples by cones, and adds them: what ConeHistory says of x'.
struct ConeCorrection {
  const float* depth;         ///< of the pixels; 0: without surface, not corrected
  const float* normal[3];     ///< unit length
  const float* direction[3];  ///< of the samples; (0,0,0), not finite or below the surface: none
  float prior_samples, most_samples;
  const ConeRows& rows;
  float* noisy[3];
};
void correct_by_cones(const ConeCorrection& block) noexcept;

}  // namespace holdfast
