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
  const Channels<float>* footprint = nullptr;  ///< E, F, G of FilterRow; null: none
};

/// Scratch of the spatial filters.
struct FilterScratch {
  Channels<float> even, odd;  ///< 3 each: signals between levels
  Channels<float> spread;     ///< 2: spread between levels
  Channels<float> guide;      ///< 3: edge-stopping luminance, inverse sigma, scratch
  Channels<float> footprint;  ///< 3: footprint narrowed by the number of samples
  ActivityMap activity;       ///< of the signal

  FilterScratch() = default;
  FilterScratch(int width, int height)
      : even(width, height, 3),
        odd(width, height, 3),
        spread(width, height, 2),
        guide(width, height, 3),
        footprint(width, height, 3),
        activity(width, height) {}
  std::size_t bytes() const {
    return even.bytes() + odd.bytes() + spread.bytes() + guide.bytes() + footprint.bytes();
  }
};

}  // namespace holdfast
