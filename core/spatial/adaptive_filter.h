#pragma once

#include "core/spatial/guided_filter.h"
#include "core/spatial/signal.h"
#include "core/spatial/tap_weights.h"

namespace holdfast {

inline constexpr int kMostLevels = 8;  ///< of `adaptive_filter`: a reach of 510 pixels

/// Constants of `adaptive_filter` that differ between components.
struct AdaptiveFilterSettings {
  int levels = 3;                 ///< a-trous levels, 1..kMostLevels
  int radius = 2;                 ///< of their kernel: 1 (3x3 taps) or 2 (5x5)
  float luminance_sigma = 16.0f;  ///< in standard deviations of the edge-stopping luminance
};

/// The filter of every recipe but `svgf`: an a-trous filter (3x3: 1/4 1/2 1/4; 5x5: 1/16 1/4 3/8
/// 1/4 1/16 a dimension) whose taps count by the samples behind them (a pixel without history
/// borrows from neighbours with long history, not the reverse), stopped at geometry, at edges of a
/// prefiltered luminance, and, for a visibility, outside the penumbra's footprint (axis-aligned
/// filtering of soft shadows, Mehta et al. 2012). The footprint narrows with samples^-1/8 per axis,
/// since what has less noise needs less blur.
///   reads guides, signal | writes `out` (1 or 3 channels), `weights` of the guides | halo
/// radius (2^levels - 1) + 3 px
void adaptive_filter(const Guides& guides, const Signal& signal,
                     const AdaptiveFilterSettings& settings, TapWeights& weights,
                     FilterScratch& scratch, Plane& out);

}  // namespace holdfast
