#include "core/spatial/filter_rows.h"

#include <cmath>

#include "core/kernels/variants.h"

namespace holdfast {
namespace {

HOLDFAST_INLINE void luminance_kernel_body(const LuminanceRow& a) {
  const float* __restrict r = a.in[0];
  const float* __restrict g = a.channels == 3 ? a.in[1] : nullptr;
  const float* __restrict b = a.channels == 3 ? a.in[2] : nullptr;
  float* __restrict out = a.out;
  if (a.channels == 3)
    for (int x = 0; x < a.width; ++x) out[x] = luminance(r[x], g[x], b[x]);
  else
    for (int x = 0; x < a.width; ++x) out[x] = r[x];
  if (a.squares == nullptr) return;
  float* __restrict squares = a.squares;
  for (int x = 0; x < a.width; ++x) squares[x] = square(out[x]);
}

HOLDFAST_INLINE void tolerance_kernel_body(const ToleranceRow& a) {
  const float* __restrict mean = a.mean;
  const float* __restrict variance = a.variance;
  const float* __restrict samples = a.samples;
  float* __restrict out = a.out;
  for (int x = 0; x < a.width; ++x)
    out[x] = 1.0f / (a.sigma * __builtin_sqrtf(variance[x] / samples[x]) + 1e-3f * abs_of(mean[x]) +
                     1e-20f);
}

HOLDFAST_INLINE void narrow_kernel_body(const NarrowRow& a) {
  const float* __restrict samples = a.samples;
  const float* __restrict in0 = a.in[0];
  const float* __restrict in1 = a.in[1];
  const float* __restrict in2 = a.in[2];
  float* __restrict out0 = a.out[0];
  float* __restrict out1 = a.out[1];
  float* __restrict out2 = a.out[2];
#pragma GCC ivdep
  for (int x = 0; x < a.width; ++x) {
    const float scale = __builtin_sqrtf(__builtin_sqrtf(samples[x]));
    out0[x] = in0[x] * scale;
    out1[x] = in1[x] * scale;
    out2[x] = in2[x] * scale;
  }
}

HOLDFAST_INLINE void statistics_kernel_body(const StatisticsRow& a) {
  const float* __restrict mean = a.mean;
  const float* squares = a.square;
  float* variance = a.variance;
#pragma GCC ivdep
  for (int x = 0; x < a.width; ++x) {
    const float mean_square = square(mean[x]);
    variance[x] = max_of(squares[x] - mean_square, a.floor_share * mean_square + a.floor_0);
  }
  if (a.valid == nullptr) return;
  const float* __restrict valid = a.valid;
  for (int c = 0; c < 3; ++c) {
    const float* __restrict precision = a.precision[c];
    float* __restrict out = a.footprint[c];
    for (int x = 0; x < a.width; ++x) out[x] = precision[x] / max_of(valid[x], kLeastFieldShare);
  }
}

HOLDFAST_INLINE void moment_variance_kernel_body(const MomentVarianceRow& a) {
  const float* __restrict moment_1 = a.moment_1;
  const float* __restrict moment_2 = a.moment_2;
  const float* __restrict samples = a.samples;
  const float* __restrict sample_variance = a.sample_variance;
  float* __restrict out = a.out;
  for (int x = 0; x < a.width; ++x) {
    const float variance = max_of(moment_2[x] - square(moment_1[x]), 0.0f);
    const float young = max_of(variance, sample_variance[x]) * kYoungFrames / samples[x];
    out[x] = samples[x] < kYoung ? young : variance;
  }
}

/// The tolerance at x, whose neighbours are columns `left` and `right`.
HOLDFAST_INLINE float smooth_tolerance(const SmoothToleranceRow& a, int left, int x, int right) {
  const float *above = a.variance[0], *own = a.variance[1], *below = a.variance[2];
  const float middle = 0.25f * above[x] + 0.5f * own[x] + 0.25f * below[x];
  const float beside = 0.25f * (above[left] + above[right]) + 0.5f * (own[left] + own[right]) +
                       0.25f * (below[left] + below[right]);
  return 1.0f / (a.sigma * __builtin_sqrtf(0.5f * middle + 0.25f * beside) +
                 1e-4f * a.luminance[x] + 1e-20f);
}

HOLDFAST_INLINE void smooth_tolerance_kernel_body(const SmoothToleranceRow& a) {
  const int last = a.width - 1;
  float* out = a.out;
  out[0] = smooth_tolerance(a, 0, 0, min_of(1, last));
#pragma GCC ivdep
  for (int x = 1; x < last; ++x) out[x] = smooth_tolerance(a, x - 1, x, x + 1);
  out[last] = smooth_tolerance(a, max_of(last - 1, 0), last, last);
}

HOLDFAST_KERNEL(luminance_kernel, LuminanceRow)
HOLDFAST_KERNEL(tolerance_kernel, ToleranceRow)
HOLDFAST_KERNEL(narrow_kernel, NarrowRow)
HOLDFAST_KERNEL(statistics_kernel, StatisticsRow)
HOLDFAST_KERNEL(moment_variance_kernel, MomentVarianceRow)
HOLDFAST_KERNEL(smooth_tolerance_kernel, SmoothToleranceRow)

}  // namespace

void luminance_row(const LuminanceRow& row) noexcept { luminance_kernel(row); }
void tolerance_row(const ToleranceRow& row) noexcept { tolerance_kernel(row); }
void narrow_row(const NarrowRow& row) noexcept { narrow_kernel(row); }
void statistics_row(const StatisticsRow& row) noexcept { statistics_kernel(row); }
void moment_variance_row(const MomentVarianceRow& row) noexcept { moment_variance_kernel(row); }
void smooth_tolerance_row(const SmoothToleranceRow& row) noexcept { smooth_tolerance_kernel(row); }

}  // namespace holdfast
