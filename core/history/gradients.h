#pragma once

#include <cstdint>

#include "core/frame/guides.h"
#include "core/frame/plane_size.h"

namespace holdfast {

/// Scratch of gradient samples: images with one pixel for each stratum of 3x3 pixels.
struct GradientScratch {
  Guides guides;             ///< of the strata's middle pixels
  Channels<float> samples;   ///< of one component: delta = now - then, Delta = max(now, then), and
                             ///< 1 where that is a sample
  Channels<float> filtered;  ///< 3: the same between passes
  Channels<float> antilag;   ///< 1: the result

  GradientScratch() = default;
  /// For frames of that size.
  GradientScratch(int frame_width, int frame_height, Memory memory = Memory::kOwned);
  static void each_image(auto& s, auto&& visit) {
    Guides::each_image(s.guides, visit);
    for (auto* images : {&s.samples, &s.filtered, &s.antilag}) visit(*images);
  }
};

/// A component's gradient plane into `scratch.samples`. A sample that is not finite or negative
/// becomes (0, 0), which is none, and one above `largest` that. Returns how many values that were.
std::uint64_t load_gradients(const Plane& plane, float largest, GradientScratch& scratch);

/// How much faster than usual history must be replaced because the light changes (A-SVGF, Schied et
/// al. 2018): with delta and Delta of `scratch.samples` filtered by `levels` passes of a 3x3
/// a-trous filter that stays on a surface,
///   lambda = min(1, |delta| / Delta), 0 where Delta is 0, and less where less than a thousandth of
/// the samples nearby are any.
/// Returns lambda, one value for each stratum, in `scratch.antilag`. More levels bring less noise,
/// but dilute what changes in a narrow strip, such as the edge of a shadow.
///   reads guides, samples | writes antilag | halo 2^levels - 1 strata
ChannelView<const float> antilag_of_gradients(const Guides& now, int levels,
                                              GradientScratch& scratch);

}  // namespace holdfast
