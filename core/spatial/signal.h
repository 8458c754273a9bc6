#pragma once

#include "core/frame/plane.h"
#include "core/kernels/math.h"
#include "core/spatial/activity.h"

namespace holdfast {

/// What a spatial filter is given: the accumulated signal of one component.
struct Signal {
  const Channels<float>* values = nullptr;     ///< `channels` of them
  int channels = 1;                            ///< 1 (visibility) or 3 (linear RGB)
  ChannelView<const float> samples;            ///< number of equal samples behind each pixel, >= 1
  ChannelView<const float> sample_variance;    ///< variance of the luminance of one sample, > 0
  const Channels<float>* footprint = nullptr;  ///< E, F, G of FilterPass; null: none
};

/// Scratch of the spatial filters.
struct FilterScratch {
  Channels<float> even, odd;  ///< 3 each: signals between levels
  Channels<float> spread;     ///< 2: spread between levels
  Channels<float> guide;      ///< 3: edge-stopping luminance, inverse sigma, scratch
  Channels<float> footprint;  ///< 3: footprint narrowed by the number of samples
  ActivityMap activity;       ///< of the signal

  FilterScratch() = default;
  FilterScratch(int width, int height, Memory memory = Memory::kOwned)
      : even(width, height, 3, memory),
        odd(width, height, 3, memory),
        spread(width, height, 2, memory),
        guide(width, height, 3, memory),
        footprint(width, height, 3, memory),
        activity(width, height) {}
  static void each_image(auto& s, auto&& visit) {
    for (auto* images : {&s.even, &s.odd, &s.spread, &s.guide, &s.footprint}) visit(*images);
  }
};

}  // namespace holdfast
