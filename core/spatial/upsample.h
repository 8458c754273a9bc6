#pragma once

#include "core/frame/guides.h"
#include "core/spatial/half_grid.h"

namespace holdfast {

/// Joint bilateral upsampling (Kopf et al. 2007): brings a signal filtered at half size to a
/// frame's own pixels. Pixel p of the full image takes the mean of the 2x2 nearest half pixels q,
/// of which each counts
///   g(q) = b(q) [id_p = id_q] exp(-(|plane distance| / (2 px) + normal_power (1 - n_p . n_q)))
/// b(q) being the bilinear weight (9, 3, 3, 1 sixteenths), the plane distance that of q's surface
/// point from p's tangent plane, px the width of a pixel at p's depth; normal_power is that of
/// FilterWeights. Where the sum of g is below kLeastWeight, the most similar of the 5x5 nearest
/// half pixels stands in: that of the same id first, then that of the largest g with a Gaussian of
/// one half pixel for b. p's own quad is among them and shows a surface, if p does.
///   reads guides of both sizes, `in` | writes `out` (1 or 3 channels) | halo 2 half pixels
struct Upsample {
  const Guides* full = nullptr;
  const Guides* half = nullptr;
  int channels = 0;
  ChannelView<const float> in[3];      ///< of half size
  ChannelView<const float> beyond[3];  ///< of full size: what pixels without surface show
  ChannelView<float> out[3];           ///< of full size
};

inline constexpr float kLeastWeight = 1e-3f;  ///< of the 2x2 nearest half pixels; ours

/// Runs the pass, in parallel.
void upsample(const Upsample& pass);

}  // namespace holdfast
