#pragma once

#include "core/spatial/filter_taps.h"
#include "core/spatial/tap_weights.h"

/// The taps of guided_filter.cpp whose weights by geometry are kept: 3x3, without luminance.
namespace holdfast {

/// Weights of taps by the kernel, for weights that are kept as integers: in the pixel's row or
/// column, and across corners.
struct KeptKernel {
  float beside, corner;
};

HOLDFAST_INLINE KeptKernel kept_kernel(const FilterWeights& weights) {
  const float unit = weights.kernel[1] / TapWeights::kOne;
  return {weights.kernel[0] * unit, weights.kernel[1] * unit};
}

HOLDFAST_INLINE float lower_weight(std::uint32_t word) {
  return static_cast<float>(static_cast<std::int32_t>(word & 0xffffu));
}

HOLDFAST_INLINE float upper_weight(std::uint32_t word) {
  return static_cast<float>(static_cast<std::int32_t>(word >> 16));
}

/// What a pixel's footprint leaves of opposite taps, which it weighs alike, times the kernel.
struct PairWeights {
  float beside, column, falling, rising;  ///< falling: from the upper left to the lower right
};

template <bool kFootprint>
HOLDFAST_INLINE PairWeights pair_weights(const FilterBlock& b, int i, float area,
                                         const KeptKernel& kernel) {
  if constexpr (!kFootprint) {
    return {kernel.beside, kernel.beside, kernel.corner, kernel.corner};
  } else {
    const float bits = weight_bits(0.0f);
    const float xx = area * b.footprint_xx[i], yy = area * b.footprint_yy[i];
    const float xy = 2.0f * area * b.footprint_xy[i];
    return {kernel.beside * weight_exp(bits, xx), kernel.beside * weight_exp(bits, yy),
            kernel.corner * weight_exp(bits, positive_part(xx + yy + xy)),
            kernel.corner * weight_exp(bits, positive_part(xx + yy - xy))};
  }
}

/// The rows that the taps of a block lie in.
struct KeptRows {
  TapRow above, own, below;
};

/// Copies of them.
struct PaddedKeptRows {
  PaddedRows<TapWeights::kSteps> above, own, below;
};

template <int C, Spread kSpread>
HOLDFAST_INLINE KeptRows kept_rows(const FilterRow& a, int x0, int count, PaddedKeptRows* padded) {
  const FilterPass& pass = a.pass;
  constexpr TapReads kReads{false, false, kSpread != Spread::kNone};
  // In place of a row outside the image, where taps weigh nothing, the pixel's own.
  const int above = a.y >= pass.step ? a.y - pass.step : a.y;
  const int below = a.y + pass.step < pass.guides->view.height ? a.y + pass.step : a.y;
  if (padded == nullptr)
    return {tap_row<C, kReads>(pass, x0, above), tap_row<C, kReads>(pass, x0, a.y),
            tap_row<C, kReads>(pass, x0, below)};
  return {padded_tap_row<C, kReads>(pass, x0, count, above, padded->above),
          padded_tap_row<C, kReads>(pass, x0, count, a.y, padded->own),
          padded_tap_row<C, kReads>(pass, x0, count, below, padded->below)};
}

/// The sums of all nine taps of a block.
template <int C, Spread kSpread, bool kFootprint>
HOLDFAST_INLINE void add_kept_taps(const FilterRow& a, const KeptRows& rows, int x0, int count,
                                   FilterBlock& b) {
  const FilterPass& pass = a.pass;
  const int step = pass.step, y = a.y;
  const std::uint32_t *of_above = pass.kept->row(step, TapWeights::kAbove, y) + x0,
                      *of_own = pass.kept->row(step, TapWeights::kBeside, y) + x0,
                      *of_below = pass.kept->row(step, TapWeights::kBelow, y) + x0,
                      *of_column = pass.kept->row(step, TapWeights::kColumn, y) + x0;
  const TapRow above = rows.above, own = rows.own, below = rows.below;
  const KeptKernel kernel = kept_kernel(pass.weights);
  const float own_weight = pass.weights.kernel[0] * pass.weights.kernel[0];
  const float area = static_cast<float>(step * step) * pass.footprint_precision;
#pragma GCC ivdep
  for (int i = 0; i < count; ++i) {
    const PairWeights pair = pair_weights<kFootprint>(b, i, area, kernel);
    FilterSums<C> s{};
    add_weighted<C, kSpread>(own, i, own_weight, s);
    add_weighted<C, kSpread>(above, i - step, pair.falling * lower_weight(of_above[i]), s);
    add_weighted<C, kSpread>(above, i, pair.column * lower_weight(of_column[i]), s);
    add_weighted<C, kSpread>(above, i + step, pair.rising * upper_weight(of_above[i]), s);
    add_weighted<C, kSpread>(own, i - step, pair.beside * lower_weight(of_own[i]), s);
    add_weighted<C, kSpread>(own, i + step, pair.beside * upper_weight(of_own[i]), s);
    add_weighted<C, kSpread>(below, i - step, pair.rising * lower_weight(of_below[i]), s);
    add_weighted<C, kSpread>(below, i, pair.column * upper_weight(of_column[i]), s);
    add_weighted<C, kSpread>(below, i + step, pair.falling * upper_weight(of_below[i]), s);
    store_sums<C>(s, b, i);
  }
}

}  // namespace holdfast
