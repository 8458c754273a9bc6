#pragma once

#include <span>

namespace holdfast::measure {

/// What lies outside the image.
enum class Border {
  kReplicate,  ///< the nearest pixel inside
  kZero,
};

/// Separable convolution of a width x height image: `out(x,y) = sum_ij row[i] col[j] in(x+i-r,
/// y+j-s)` with r, s the half lengths (taps are not mirrored). Lengths are odd. Runs on all cores;
/// the result does not depend on their number. `out` may be `in`.
void convolve(const float* in, int width, int height, std::span<const float> row_taps,
              std::span<const float> column_taps, Border border, float* out);

}  // namespace holdfast::measure
