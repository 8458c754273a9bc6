#pragma once

#include "core/spatial/activity.h"

/// One pass of an edge-stopping filter with holes (a-trous) over up to kMaxFilterChannels signals.
///
///   reads   guides, signals, variance and luminance (optional)
///   writes  filtered signals, filtered variance (optional)
///   halo    radius * step pixels; taps outside the image are left out
///   state   none
namespace holdfast {

class TapWeights;

inline constexpr int kMaxFilterChannels = 8;
inline constexpr int kGreatestStep = 128;

/// Weights of a pass. A tap q of pixel p counts
///   g(q) = h(q) exp(-(|plane distance| / (plane_sigma_px * step * footprint)
///                    + normal_power (1 - n_p . n_q)
///                    + |l_p - l_q| inverse_luminance_sigma_p
///                    + E_p dx^2 + 2 F_p dx dy + G_p dy^2))
/// where the plane distance is that of q's surface point from p's tangent plane and the footprint
/// is the width of a pixel at p's depth. exp(-k (1 - x)) stands for SVGF's x^k (they agree to first
/// order at x = 1), so that all terms share one exponential.
struct FilterWeights {
  int radius = 2;        ///< 1: 3x3 taps, 2: 5x5
  bool diamond = false;  ///< of these only the ones with |dx| + |dy| <= radius * step
  float kernel[3] = {3.0f / 8.0f, 1.0f / 4.0f, 1.0f / 16.0f};  ///< 1-D weights by |offset|
  float plane_sigma_px = 1.0f;
  float normal_power = 128.0f;  ///< >= 88, so that taps without surface vanish; SVGF sec. 4.3
};

/// What the spread channel of a pass holds.
enum class Spread {
  kVariance,  ///< variance v: out = sum g in / sum g,  v' = sum g^2 v / (sum g)^2 (SVGF eq. 5)
  kNone,      ///< there is none: out as of kVariance
  kSamples,   ///< number of equal samples N behind each pixel, > 0, which also weighs it:
              ///< out = sum g N in / sum g N,  N' = (sum g N)^2 / sum g^2 N
};

/// One pass over an image. All images share size and stride, and 0 beside their rows (kApron).
/// Pixels without surface (depth 0) copy their inputs; taps without surface have weight 0.
struct FilterPass {
  const Guides* guides = nullptr;
  FilterWeights weights;
  int step = 1;      ///< 1..kGreatestStep
  int channels = 0;  ///< 1..kMaxFilterChannels
  ChannelView<const float> in[kMaxFilterChannels];
  ChannelView<float> out[kMaxFilterChannels];
  Spread spread = Spread::kVariance;
  ChannelView<const float> spread_in;
  ChannelView<float> spread_out;
  /// Edge-stopping luminance, and per pixel 1 / luminance_sigma. Both or neither.
  ChannelView<const float> luminance;
  ChannelView<const float> inverse_luminance_sigma;
  /// Receives the luminance of what is written. Optional, of three channels with luminance and
  /// kVariance.
  ChannelView<float> luminance_out;
  /// Footprint E, F, G in 1 / px^2: half the inverse covariance of a Gaussian. All or none.
  ChannelView<const float> footprint[3];
  float footprint_precision = 1.0f;  ///< multiplies it; of passes without luminance
  /// Where the weights by geometry are kept from pass to pass. Without luminance, passes of 1, 2,
  /// 4, 7 and 8 channels need it; others do not look at it.
  TapWeights* kept = nullptr;
  /// Tiles at rest copy their inputs. Null: all tiles are active.
  const ActivityMap* activity = nullptr;
  int activity_zone = ActivityMap::kWidestZone;  ///< of `activity`, outside which tiles rest
};

/// Runs row y of the pass on the selected instruction set. Compiled for the combinations that the
/// pipeline uses: without luminance, 3x3 taps at steps 1 to 3 of 1 channel with kSamples or 2 or 4
/// with kVariance (with or without footprint), or of 1, 2, 7 or 8 channels with kNone, or 3
/// channels with kNone at any step and size; with luminance, 1 or 3 channels with either spread, or
/// with kSamples and footprint. Asserts that the combination is one of these.
void filter_row(const FilterPass& pass, int y) noexcept;

/// Runs every row, in parallel. Inputs and outputs must not overlap.
void filter_image(const FilterPass& pass);

}  // namespace holdfast
