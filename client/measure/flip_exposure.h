#pragma once

#include <vector>

#include "client/measure/image.h"

namespace holdfast::measure {

/// Bounds time and memory where references span more than 16 stops.
inline constexpr int kMostFlipExposures = 16;

/// The exposures, in stops, at which HDR-FLIP compares an image pair (Andersson et al. 2021, sec.
/// 4): from the one that maps the brightest luminance to 0.85 of the display to the one that maps
/// the median there, N = max(2, ceil(stop - start)) of them, evenly spread. Only pixels on
/// `surface` count. Ours: a median of 0 is replaced by the median of the positive luminances, and a
/// black image is compared at exposure 0 alone.
std::vector<float> flip_exposures(const Image& reference_rgb, const Mask& surface);

/// The ACES curve of HDR-FLIP: display value in [0,1] (linear light) of exposed radiance >= 0.
float aces_tonemap(float value);

}  // namespace holdfast::measure
