#include "core/spatial/guided_filter.h"

#include <cassert>
#include <cmath>

#include "core/kernels/parallel.h"
#include "core/kernels/variants.h"
#include "core/spatial/kept_taps.h"

namespace holdfast {
namespace {

// A sum of weights whose square is still a float. A pixel has less only where rounding takes its
// own point off its plane, as under pixels of 1e-9 m some metres away: it then stays as it is.
constexpr float kLeastWeight = 1e-15f;

constexpr int kGreatestReach = 2 * kGreatestStep;  // of taps, pixels

/// What the weights of a pass are made of.
enum class Weights {
  kKept,       ///< geometry, as kept for the frame
  kGeometry,   ///< geometry, found here
  kLuminance,  ///< likewise, and luminance
};

struct RowBits {
  float of[3];
};

/// weight_bits of the taps of row ky by their distance in columns.
HOLDFAST_INLINE RowBits row_bits(const FilterRow& a, int ky) {
  const float hy = a.log2_kernel[abs_of(ky)];
  return {{weight_bits(hy + a.log2_kernel[0]), weight_bits(hy + a.log2_kernel[1]),
           weight_bits(hy + a.log2_kernel[2])}};
}

/// Taps to either side in the row at distance ky.
HOLDFAST_INLINE int half_width(const FilterWeights& weights, int ky) {
  return weights.diamond ? weights.radius - abs_of(ky) : weights.radius;
}

/// All taps of one row.
template <int C, bool kLuminance, Spread kSpread, bool kFootprint, int kRadius>
HOLDFAST_INLINE void add_taps(const FilterRow& a, const TapRow& t, int count, int ky,
                              FilterBlock& b) {
  const int step = a.pass.step;
  const RowBits bits = row_bits(a, ky);
  const float dy = static_cast<float>(ky * step);
#pragma GCC ivdep
  for (int i = 0; i < count; ++i) {
    const FilterPixel p = load_pixel<kLuminance, kFootprint>(b, i, dy);
    FilterSums<C> s = load_sums<C>(b, i);
    add_row_taps<C, kLuminance, kSpread, kFootprint, kRadius>(t, i, step, bits.of, p, s);
    store_sums<C>(s, b, i);
  }
}

/// The sums of a block whose weights are found here.
template <int C, bool kLuminance, Spread kSpread, bool kFootprint>
HOLDFAST_INLINE void sum_up(const FilterRow& a, int x0, int count, FilterBlock& b) {
  const FilterPass& pass = a.pass;
  constexpr TapReads kReads{true, kLuminance, kSpread != Spread::kNone};
  load_tangent_planes(*pass.guides, pass.weights.plane_sigma_px * static_cast<float>(pass.step), x0,
                      a.y, count, b);
  for (float* normal : {b.nx, b.ny, b.nz})
    for (int i = 0; i < count; ++i) normal[i] *= pass.weights.normal_power;
  for (int i = 0; i < count; ++i) b.weight_sum[i] = 0.0f;
  for (int i = 0; i < count; ++i) b.spread_sum[i] = 0.0f;
  for (int c = 0; c < C; ++c)
    for (int i = 0; i < count; ++i) b.sum[c][i] = 0.0f;
  if constexpr (kLuminance) {
    b.luminance = pass.luminance.row(a.y) + x0;
    b.inverse_sigma = pass.inverse_luminance_sigma.row(a.y) + x0;
  }
  const bool copied = !has_apron(pass) && !is_inside(pass, x0, count);
  PaddedRows<kGreatestReach> padded;
  for (int ky = -pass.weights.radius; ky <= pass.weights.radius; ++ky) {
    const int qy = a.y + ky * pass.step;
    if (qy < 0 || qy >= pass.guides->view.height) continue;
    const TapRow t = copied ? padded_tap_row<C, kReads>(pass, x0, count, qy, padded)
                            : tap_row<C, kReads>(pass, x0, qy);
    switch (half_width(pass.weights, ky)) {
      case 0: add_taps<C, kLuminance, kSpread, kFootprint, 0>(a, t, count, ky, b); break;
      case 1: add_taps<C, kLuminance, kSpread, kFootprint, 1>(a, t, count, ky, b); break;
      default: add_taps<C, kLuminance, kSpread, kFootprint, 2>(a, t, count, ky, b);
    }
  }
}

/// The sums of a block whose weights are kept.
template <int C, Spread kSpread, bool kFootprint>
HOLDFAST_INLINE void sum_up_kept(const FilterRow& a, int x0, int count, FilterBlock& b) {
  const bool copied = !has_apron(a.pass) && !is_inside(a.pass, x0, count);
  PaddedKeptRows padded;
  const KeptRows rows = kept_rows<C, kSpread>(a, x0, count, copied ? &padded : nullptr);
  add_kept_taps<C, kSpread, kFootprint>(a, rows, x0, count, b);
}

/// The luminance of what has been written, where it is wanted.
HOLDFAST_INLINE void write_luminance(const FilterRow& a, int x0, int count) {
  const FilterPass& pass = a.pass;
  if (!pass.luminance_out) return;
  const float* __restrict r = pass.out[0].row(a.y) + x0;
  const float* __restrict g = pass.out[1].row(a.y) + x0;
  const float* __restrict b = pass.out[2].row(a.y) + x0;
  float* __restrict out = pass.luminance_out.row(a.y) + x0;
  for (int i = 0; i < count; ++i) out[i] = luminance(r[i], g[i], b[i]);
}

/// What the sums come to; pixels without surface, or weights, stay as they are. `kExact`: by a
/// division, so that what has no other tap stays as it is to the last bit.
template <int C, Spread kSpread, bool kExact>
HOLDFAST_INLINE void write_block(const FilterRow& a, int x0, int count, const FilterBlock& b) {
  const FilterPass& pass = a.pass;
  const float* __restrict depth = pass.guides->depth().row(a.y) + x0;
  float inverse[kFilterBlock];  // of the weight; 0: stays
  for (int i = 0; i < count; ++i) {
    const float enough = b.weight_sum[i] > kLeastWeight ? 1.0f / b.weight_sum[i] : 0.0f;
    inverse[i] = depth[i] > 0.0f ? enough : 0.0f;
  }
  for (int c = 0; c < C; ++c) {
    const float* __restrict in = pass.in[c].row(a.y) + x0;
    float* __restrict out = pass.out[c].row(a.y) + x0;
    for (int i = 0; i < count; ++i) {
      const float mean = kExact ? b.sum[c][i] / b.weight_sum[i] : b.sum[c][i] * inverse[i];
      out[i] = inverse[i] > 0.0f ? mean : in[i];
    }
  }
  if constexpr (C == 3 && kSpread == Spread::kVariance && kExact) write_luminance(a, x0, count);
  if constexpr (kSpread == Spread::kNone) return;
  const float* __restrict in = pass.spread_in.row(a.y) + x0;
  float* __restrict out = pass.spread_out.row(a.y) + x0;
  for (int i = 0; i < count; ++i) {
    const float variance = b.spread_sum[i] * inverse[i] * inverse[i];
    const float value = kSpread == Spread::kSamples
                            ? b.weight_sum[i] * b.weight_sum[i] / b.spread_sum[i]
                            : variance;
    out[i] = inverse[i] > 0.0f ? value : in[i];
  }
}

template <int C, Weights kWeights, Spread kSpread, bool kFootprint>
HOLDFAST_INLINE void filter_block(const FilterRow& a, int x0, int count, FilterBlock& b) {
  const FilterPass& pass = a.pass;
  if constexpr (kFootprint) {
    b.footprint_xx = pass.footprint[0].row(a.y) + x0;
    b.footprint_xy = pass.footprint[1].row(a.y) + x0;
    b.footprint_yy = pass.footprint[2].row(a.y) + x0;
  }
  if constexpr (kWeights == Weights::kKept)
    sum_up_kept<C, kSpread, kFootprint>(a, x0, count, b);
  else
    sum_up<C, kWeights == Weights::kLuminance, kSpread, kFootprint>(a, x0, count, b);
  write_block<C, kSpread, kWeights == Weights::kLuminance>(a, x0, count, b);
}

template <int C, Spread kSpread>
HOLDFAST_INLINE void copy_block(const FilterRow& a, int x0, int count) {
  const FilterPass& pass = a.pass;
  for (int c = 0; c < C; ++c) {
    const float* __restrict in = pass.in[c].row(a.y) + x0;
    float* __restrict out = pass.out[c].row(a.y) + x0;
    for (int i = 0; i < count; ++i) out[i] = in[i];
  }
  if constexpr (kSpread == Spread::kNone) return;
  const float* __restrict in = pass.spread_in.row(a.y) + x0;
  float* __restrict out = pass.spread_out.row(a.y) + x0;
  for (int i = 0; i < count; ++i) out[i] = in[i];
}

HOLDFAST_INLINE bool is_active(const FilterRow& a, int x) {
  const FilterPass& pass = a.pass;
  return pass.activity == nullptr || pass.activity->active(x, a.y, pass.activity_zone);
}

/// Where a block that begins at x0 must end at the latest: at its size, and, where rows are copied
/// for taps outside the image, where those begin or end, so that few are.
HOLDFAST_INLINE int last_end(const FilterRow& a, int x0) {
  const FilterPass& pass = a.pass;
  constexpr int kTile = ActivityMap::kTileWidth;
  const int width = pass.guides->view.width;
  const int end = min_of(x0 + kFilterBlock, width);
  if (has_apron(pass)) return end;
  const int reach = pass.weights.radius * pass.step;
  const int first = (reach + kTile - 1) / kTile * kTile, last = (width - reach) / kTile * kTile;
  if (x0 < first) return min_of(end, first);
  return x0 < last ? min_of(end, last) : end;
}

/// The row in blocks: as many neighbouring tiles as fit and are all active, or all at rest.
template <int C, Weights kWeights, Spread kSpread, bool kFootprint>
HOLDFAST_INLINE void filter_row_body(const FilterRow& a) {
  constexpr int kTile = ActivityMap::kTileWidth;
  FilterBlock block;
  const int width = a.pass.guides->view.width;
  for (int x0 = 0; x0 < width;) {
    const bool active = is_active(a, x0);
    const int limit = last_end(a, x0);
    int end = min_of(x0 + kTile, limit);
    while (end < limit && is_active(a, end) == active) end = min_of(end + kTile, limit);
    if (active)
      filter_block<C, kWeights, kSpread, kFootprint>(a, x0, end - x0, block);
    else
      copy_block<C, kSpread>(a, x0, end - x0);
    x0 = end;
  }
}

// The combinations that the pipeline uses.
HOLDFAST_INLINE void mean1_body(const FilterRow& a) {
  filter_row_body<1, Weights::kKept, Spread::kNone, false>(a);
}
HOLDFAST_INLINE void mean2_body(const FilterRow& a) {
  filter_row_body<2, Weights::kKept, Spread::kNone, false>(a);
}
HOLDFAST_INLINE void spread_mean2_body(const FilterRow& a) {
  filter_row_body<2, Weights::kKept, Spread::kVariance, false>(a);
}
HOLDFAST_INLINE void footprint_mean2_body(const FilterRow& a) {
  filter_row_body<2, Weights::kKept, Spread::kVariance, true>(a);
}
HOLDFAST_INLINE void mean3_body(const FilterRow& a) {
  filter_row_body<3, Weights::kGeometry, Spread::kNone, false>(a);
}
HOLDFAST_INLINE void spread_mean4_body(const FilterRow& a) {
  filter_row_body<4, Weights::kKept, Spread::kVariance, false>(a);
}
HOLDFAST_INLINE void footprint_mean4_body(const FilterRow& a) {
  filter_row_body<4, Weights::kKept, Spread::kVariance, true>(a);
}
HOLDFAST_INLINE void mean7_body(const FilterRow& a) {
  filter_row_body<7, Weights::kKept, Spread::kNone, false>(a);
}
HOLDFAST_INLINE void mean8_body(const FilterRow& a) {
  filter_row_body<8, Weights::kKept, Spread::kNone, false>(a);
}
HOLDFAST_INLINE void weighted_mean1_body(const FilterRow& a) {
  filter_row_body<1, Weights::kKept, Spread::kSamples, false>(a);
}
HOLDFAST_INLINE void footprint_mean1_body(const FilterRow& a) {
  filter_row_body<1, Weights::kKept, Spread::kSamples, true>(a);
}
HOLDFAST_INLINE void variance_guided1_body(const FilterRow& a) {
  filter_row_body<1, Weights::kLuminance, Spread::kVariance, false>(a);
}
HOLDFAST_INLINE void sample_weighted1_body(const FilterRow& a) {
  filter_row_body<1, Weights::kLuminance, Spread::kSamples, false>(a);
}
HOLDFAST_INLINE void variance_guided3_body(const FilterRow& a) {
  filter_row_body<3, Weights::kLuminance, Spread::kVariance, false>(a);
}
HOLDFAST_INLINE void sample_weighted3_body(const FilterRow& a) {
  filter_row_body<3, Weights::kLuminance, Spread::kSamples, false>(a);
}
HOLDFAST_INLINE void footprint_weighted3_body(const FilterRow& a) {
  filter_row_body<3, Weights::kLuminance, Spread::kSamples, true>(a);
}
HOLDFAST_INLINE void footprint_weighted1_body(const FilterRow& a) {
  filter_row_body<1, Weights::kLuminance, Spread::kSamples, true>(a);
}

/// Has the weights of the tiles of a row that are active.
void provide_weights(const FilterRow& a) noexcept {
  const FilterPass& pass = a.pass;
  constexpr int kTile = ActivityMap::kTileWidth;
  assert(pass.kept != nullptr && pass.weights.radius == 1 && TapWeights::has(pass.step));
  const int width = pass.guides->view.width;
  for (int x = 0; x < width;) {
    int end = x;
    while (end < width && is_active(a, end)) end += kTile;
    if (end > x) pass.kept->provide(pass, x, a.y, min_of(end, width) - x);
    x = end + kTile;
  }
}

HOLDFAST_KERNEL(mean1, FilterRow)
HOLDFAST_KERNEL(mean2, FilterRow)
HOLDFAST_KERNEL(spread_mean2, FilterRow)
HOLDFAST_KERNEL(footprint_mean2, FilterRow)
HOLDFAST_KERNEL(mean3, FilterRow)
HOLDFAST_KERNEL(spread_mean4, FilterRow)
HOLDFAST_KERNEL(footprint_mean4, FilterRow)
HOLDFAST_KERNEL(mean7, FilterRow)
HOLDFAST_KERNEL(mean8, FilterRow)
HOLDFAST_KERNEL(weighted_mean1, FilterRow)
HOLDFAST_KERNEL(footprint_mean1, FilterRow)
HOLDFAST_KERNEL(variance_guided1, FilterRow)
HOLDFAST_KERNEL(sample_weighted1, FilterRow)
HOLDFAST_KERNEL(variance_guided3, FilterRow)
HOLDFAST_KERNEL(sample_weighted3, FilterRow)
HOLDFAST_KERNEL(footprint_weighted1, FilterRow)
HOLDFAST_KERNEL(footprint_weighted3, FilterRow)

}  // namespace

void filter_row(const FilterPass& pass, int y) noexcept {
  FilterRow row{pass, y, {}};
  if (!pass.luminance && pass.channels != 3)
    provide_weights(row);
  else
    for (int k = 0; k <= pass.weights.radius; ++k)
      row.log2_kernel[k] = std::log2(pass.weights.kernel[k]);
  const bool one = pass.channels == 1;
  if (pass.luminance) {
    assert(one || pass.channels == 3);
    if (pass.footprint[0]) return one ? footprint_weighted1(row) : footprint_weighted3(row);
    if (pass.spread == Spread::kSamples) return one ? sample_weighted1(row) : sample_weighted3(row);
    return one ? variance_guided1(row) : variance_guided3(row);
  }
  if (pass.spread == Spread::kSamples)
    return pass.footprint[0] ? footprint_mean1(row) : weighted_mean1(row);
  if (pass.spread == Spread::kNone) switch (pass.channels) {
      case 1: return mean1(row);
      case 2: return mean2(row);
      case 3: return mean3(row);
      case 7: return mean7(row);
      default: assert(pass.channels == 8); return mean8(row);
    }
  if (pass.channels == 2) return pass.footprint[0] ? footprint_mean2(row) : spread_mean2(row);
  assert(pass.channels == 4);
  return pass.footprint[0] ? footprint_mean4(row) : spread_mean4(row);
}

void filter_image(const FilterPass& pass) {
  for_each_row(pass.guides->view.height, [&](int y) { filter_row(pass, y); });
}

}  // namespace holdfast
