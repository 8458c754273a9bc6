#pragma once

#include "core/frame/plane.h"

/// Passes of the spatial filters that look at one pixel at a time, a row a call, on the selected
/// instruction set. Halo 0; rows of one call must not overlap, but for `narrow`'s.
namespace holdfast {

/// out = luminance of the channels, Rec. 709; of one channel, the channel itself. `squares` (may be
/// null) receives its square.
struct LuminanceRow {
  const float* in[3];
  int channels, width;  ///< 1 or 3; pixels
  float *out, *squares;
};
void luminance_row(const LuminanceRow& row) noexcept;

/// out = 1 / (sigma sqrt(variance / samples) + 1e-3 |mean| + 1e-20): how many tolerances a unit of
/// luminance is. The second term keeps rounding of a noise-free signal from counting as an edge.
struct ToleranceRow {
  const float *mean, *variance, *samples;
  float sigma;
  int width;
  float* out;
};
void tolerance_row(const ToleranceRow& row) noexcept;

/// out[c] = in[c] * samples^(1/4), for the three terms of a footprint.
struct NarrowRow {
  const float *in[3], *samples;
  int width;
  float* out[3];
};
void narrow_row(const NarrowRow& row) noexcept;

/// Share of the samples nearby that must say something of an effect. What is less is the faint
/// weight of other surfaces, which is e^-87 or nothing at all by rounding: it must not decide.
inline constexpr float kLeastFieldShare = 1e-3f;

/// From local means: variance = max(square - mean^2, floor), floor = floor_share mean^2 + floor_0;
/// and, if `valid` is not null, footprint[c] = precision[c] / max(valid, kLeastFieldShare).
struct StatisticsRow {
  const float *mean, *square;
  float floor_share, floor_0;
  const float *valid, *precision[3];
  int width;
  float* variance;  ///< may be `square`
  float* footprint[3];
};
void statistics_row(const StatisticsRow& row) noexcept;

/// Frames of history below which SVGF estimates its variance in space (SVGF sec. 4.2). Counts of
/// frames are integers but for rounding, which must not decide: those below kYoung are fewer.
inline constexpr float kYoungFrames = 4.0f, kYoung = kYoungFrames - 0.5f;

/// SVGF's variance: out = max(moment_2 - moment_1^2, 0); where `samples`, frames of history, are
/// below kYoung, 4 / samples times the larger of that and `sample_variance`, which is not looked at
/// elsewhere.
struct MomentVarianceRow {
  const float *moment_1, *moment_2, *samples, *sample_variance;
  int width;
  float* out;
};
void moment_variance_row(const MomentVarianceRow& row) noexcept;

/// SVGF's tolerance: out = 1 / (sigma sqrt(v) + 1e-4 luminance + 1e-20), v the 3x3 Gaussian of the
/// variance, whose rows above, at and below the pixels are given; columns beyond the borders repeat
/// them (SVGF sec. 4.4).
struct SmoothToleranceRow {
  const float *variance[3], *luminance;
  float sigma;
  int width;
  float* out;
};
void smooth_tolerance_row(const SmoothToleranceRow& row) noexcept;

}  // namespace holdfast
