#pragma once

#include "core/oracle/surfaces.h"

namespace holdfast::oracle {

/// What the spread of a pass holds, and so how its taps are weighed: spatial/guided_filter.h.
enum class Weighting {
  kEqual,    ///< variance v: out = sum g in / sum g,  v' = sum g^2 v / (sum g)^2
  kSamples,  ///< samples N: out = sum g N in / sum g N,  N' = (sum g N)^2 / sum g^2 N
};

/// One pass of the edge-stopping filter with holes: for pixel p and tap q at offset (dx, dy),
///   g = h exp(-(|plane distance| / (step width) + 128 (1 - n_p . n_q)
///              + |l_p - l_q| inverse_sigma_p + E dx^2 + 2 F dx dy + G dy^2))
/// Taps outside the image or without surface are left out; pixels without surface copy.
struct Pass {
  int radius = 2;
  bool diamond = false;                             ///< only taps with |dx| + |dy| <= radius * step
  double kernel[3] = {3.0 / 8, 1.0 / 4, 1.0 / 16};  ///< by |offset|
  int step = 1;
  Weighting weighting = Weighting::kEqual;
  const Image* luminance = nullptr;      ///< edge-stopping, with ...
  const Image* inverse_sigma = nullptr;  ///< ... its inverse tolerance; both or neither
  const Image* footprint = nullptr;      ///< E, F, G, px^-2 ...
  double footprint_precision = 1;        ///< ... and what multiplies it
};
inline constexpr int kMostFilterChannels = 28;

struct Filtered {
  Image values, spread;
};
Filtered filter_pass(const Surfaces& surfaces, const Image& values, const Image& spread,
                     const Pass& pass);

/// 3x3 taps: equal, or 1/4 1/2 1/4 a dimension.
Pass box_pass(int step);
Pass tent_pass(int step);

/// The kernels of spatial/adaptive_filter.h, by their number of taps.
Pass kernel_pass(int taps, int step);

/// spatial/window.h: means over a window of 3 + 2 second_step pixels that stays on the surface, and
/// 1/n, n the equal samples in each.
Filtered window_means(const Surfaces& surfaces, const Image& values, int second_step,
                      const Image* footprint = nullptr, double footprint_precision = 1);

}  // namespace holdfast::oracle
