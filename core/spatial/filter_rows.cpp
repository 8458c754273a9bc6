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

HOLDFAST_KERNEL(luminance_kernel, LuminanceRow)
HOLDFAST_KERNEL(tolerance_kernel, ToleranceRow)
HOLDFAST_KERNEL(narrow_kernel, NarrowRow)
HOLDFAST_KERNEL(statistics_kernel, StatisticsRow)

}  // namespace

void luminance_row(const LuminanceRow& row) noexcept { luminance_kernel(row); }
void tolerance_row(const ToleranceRow& row) noexcept { tolerance_kernel(row); }
void narrow_row(const NarrowRow& row) noexcept { narrow_kernel(row); }
void statistics_row(const StatisticsRow& row) noexcept { statistics_kernel(row); }

}  // namespace holdfast
