#pragma once

#include "core/spatial/guided_filter.h"
#include "core/spatial/signal.h"

namespace holdfast {

/// SVGF's spatial filter as published (Schied et al. 2017, sec. 4.2-4.4): variance from the
/// accumulated moments, or 4/n times the local estimate while history is younger than 4 frames;
/// then `levels` of a 5x5 a-trous filter, each stopped by the luminance in terms of the variance
/// after a 3x3 Gaussian. Our difference: plane distances instead of depth gradients.
///   reads guides, signal (`samples` are frames of history), moments: mean and mean square of the
///   luminance | writes `out`, and the first level into `feedback`; `values` of the signal are
///   neither, and may be the scratch's `odd` | halo 2 (2^levels - 1) + levels
///   px
void svgf_filter(const Guides& guides, const Signal& signal, ChannelView<const float> moment_1,
                 ChannelView<const float> moment_2, int levels, FilterScratch& scratch,
                 Channels<float>& feedback, Plane& out);

}  // namespace holdfast
