#pragma once

#include "core/spatial/guided_filter.h"
#include "core/spatial/signal.h"
#include "core/spatial/tap_weights.h"

namespace holdfast {

inline constexpr int kMostLevels = 8;  ///< of `adaptive_filter`: a reach of 510 pixels

/// Constants of `adaptive_filter` that differ between components.
struct AdaptiveFilterSettings {
  int levels = 3;                 ///< a-trous levels, 1..kMostLevels
  int taps = 13;                  ///< of their kernel, as `kernel_of` has them
  float luminance_sigma = 16.0f;  ///< in standard deviations of the edge-stopping luminance
};

/// The kernel of 9 taps (3x3: 1/4 1/2 1/4 a dimension), 13 (of 5x5 those within |dx| + |dy| <= 2
/// steps, flatter; ours, tuned for the least error over five scenes) or 25 (5x5: SVGF's).
FilterWeights kernel_of(int taps);

/// The filter of every recipe but `svgf`: an a-trous filter whose taps count by the samples behind
/// them (a pixel without history borrows from neighbours with long history, not the reverse),
/// stopped at geometry, at edges of a prefiltered luminance, and, for a visibility, outside the
/// penumbra's footprint (axis-aligned filtering of soft shadows, Mehta et al. 2012). The footprint
/// narrows with samples^-1/8 per axis, since what has less noise needs less blur.
///   reads guides, signal | writes `out` (1 or 3 channels), `weights` of the guides | halo
/// radius (2^levels - 1) + 3 px
void adaptive_filter(const Guides& guides, const Signal& signal,
                     const AdaptiveFilterSettings& settings, TapWeights& weights,
                     FilterScratch& scratch, Plane& out);

}  // namespace holdfast
