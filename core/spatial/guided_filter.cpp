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

/// A row, and the logarithms of its kernel's weights at distance 0, 1 and 2.
struct RowPass {
  const FilterRow& row;
  float log2_kernel[3];
};

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
HOLDFAST_INLINE RowBits row_bits(const RowPass& pass, int ky) {
  const float hy = pass.log2_kernel[abs_of(ky)];
  return {{weight_bits(hy + pass.log2_kernel[0]), weight_bits(hy + pass.log2_kernel[1]),
           weight_bits(hy + pass.log2_kernel[2])}};
}

/// Taps to either side in the row at distance ky.
HOLDFAST_INLINE int half_width(const FilterWeights& weights, int ky) {
  return weights.diamond ? weights.radius - abs_of(ky) : weights.radius;
}

/// All taps of one row.
template <int C, bool kLuminance, Spread kSpread, bool kFootprint, int kRadius>
HOLDFAST_INLINE void add_taps(const RowPass& pass, const TapRow& t, int count, int ky,
                              FilterBlock& b) {
  const int step = pass.row.step;
  const RowBits bits = row_bits(pass, ky);
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
HOLDFAST_INLINE void sum_up(const RowPass& pass, int x0, int count, FilterBlock& b) {
  const FilterRow& a = pass.row;
  constexpr TapReads kReads{true, kLuminance, kSpread != Spread::kNone};
  load_tangent_planes(*a.guides, a.weights.plane_sigma_px * static_cast<float>(a.step), x0, a.y,
                      count, b);
  for (float* normal : {b.nx, b.ny, b.nz})
    for (int i = 0; i < count; ++i) normal[i] *= a.weights.normal_power;
  for (int i = 0; i < count; ++i) b.weight_sum[i] = 0.0f;
  for (int i = 0; i < count; ++i) b.spread_sum[i] = 0.0f;
  for (int c = 0; c < C; ++c)
    for (int i = 0; i < count; ++i) b.sum[c][i] = 0.0f;
  if constexpr (kLuminance) {
    b.luminance = a.luminance.row(a.y) + x0;
    b.inverse_sigma = a.inverse_luminance_sigma.row(a.y) + x0;
  }
  const bool copied = !has_apron(a) && !is_inside(a, x0, count);
  PaddedRows<kGreatestReach> padded;
  for (int ky = -a.weights.radius; ky <= a.weights.radius; ++ky) {
    const int qy = a.y + ky * a.step;
    if (qy < 0 || qy >= a.guides->view.height) continue;
    const TapRow t = copied ? padded_tap_row<C, kReads>(a, x0, count, qy, padded)
                            : tap_row<C, kReads>(a, x0, qy);
    switch (half_width(a.weights, ky)) {
      case 0: add_taps<C, kLuminance, kSpread, kFootprint, 0>(pass, t, count, ky, b); break;
      case 1: add_taps<C, kLuminance, kSpread, kFootprint, 1>(pass, t, count, ky, b); break;
      default: add_taps<C, kLuminance, kSpread, kFootprint, 2>(pass, t, count, ky, b);
    }
  }
}

/// The sums of a block whose weights are kept.
template <int C, Spread kSpread, bool kFootprint>
HOLDFAST_INLINE void sum_up_kept(const FilterRow& a, int x0, int count, FilterBlock& b) {
  const bool copied = !has_apron(a) && !is_inside(a, x0, count);
  PaddedKeptRows padded;
  const KeptRows rows = kept_rows<C, kSpread>(a, x0, count, copied ? &padded : nullptr);
  add_kept_taps<C, kSpread, kFootprint>(a, rows, x0, count, b);
}

/// The luminance of what has been written, where it is wanted.
HOLDFAST_INLINE void write_luminance(const FilterRow& a, int x0, int count) {
  if (!a.luminance_out) return;
  const float* __restrict r = a.out[0].row(a.y) + x0;
  const float* __restrict g = a.out[1].row(a.y) + x0;
  const float* __restrict b = a.out[2].row(a.y) + x0;
  float* __restrict out = a.luminance_out.row(a.y) + x0;
  for (int i = 0; i < count; ++i) out[i] = luminance(r[i], g[i], b[i]);
}

/// What the sums come to; pixels without surface, or weights, stay as they are. `kExact`: by a
/// division, so that what has no other tap stays as it is to the last bit.
template <int C, Spread kSpread, bool kExact>
HOLDFAST_INLINE void write_block(const FilterRow& a, int x0, int count, const FilterBlock& b) {
  const float* __restrict depth = a.guides->depth().row(a.y) + x0;
  float inverse[kFilterBlock];  // of the weight; 0: stays
  for (int i = 0; i < count; ++i) {
    const float enough = b.weight_sum[i] > kLeastWeight ? 1.0f / b.weight_sum[i] : 0.0f;
    inverse[i] = depth[i] > 0.0f ? enough : 0.0f;
  }
  for (int c = 0; c < C; ++c) {
    const float* __restrict in = a.in[c].row(a.y) + x0;
    float* __restrict out = a.out[c].row(a.y) + x0;
    for (int i = 0; i < count; ++i) {
      const float mean = kExact ? b.sum[c][i] / b.weight_sum[i] : b.sum[c][i] * inverse[i];
      out[i] = inverse[i] > 0.0f ? mean : in[i];
    }
  }
  if constexpr (C == 3 && kSpread == Spread::kVariance && kExact) write_luminance(a, x0, count);
  if constexpr (kSpread == Spread::kNone) return;
  const float* __restrict in = a.spread_in.row(a.y) + x0;
  float* __restrict out = a.spread_out.row(a.y) + x0;
  for (int i = 0; i < count; ++i) {
    const float variance = b.spread_sum[i] * inverse[i] * inverse[i];
    const float value = kSpread == Spread::kSamples
                            ? b.weight_sum[i] * b.weight_sum[i] / b.spread_sum[i]
                            : variance;
    out[i] = inverse[i] > 0.0f ? value : in[i];
  }
}

template <int C, Weights kWeights, Spread kSpread, bool kFootprint>
HOLDFAST_INLINE void filter_block(const RowPass& pass, int x0, int count, FilterBlock& b) {
  const FilterRow& a = pass.row;
  if constexpr (kFootprint) {
    b.footprint_xx = a.footprint[0].row(a.y) + x0;
    b.footprint_xy = a.footprint[1].row(a.y) + x0;
    b.footprint_yy = a.footprint[2].row(a.y) + x0;
  }
  if constexpr (kWeights == Weights::kKept)
    sum_up_kept<C, kSpread, kFootprint>(a, x0, count, b);
  else
    sum_up<C, kWeights == Weights::kLuminance, kSpread, kFootprint>(pass, x0, count, b);
  write_block<C, kSpread, kWeights == Weights::kLuminance>(a, x0, count, b);
}

template <int C, Spread kSpread>
HOLDFAST_INLINE void copy_block(const FilterRow& a, int x0, int count) {
  for (int c = 0; c < C; ++c) {
    const float* __restrict in = a.in[c].row(a.y) + x0;
    float* __restrict out = a.out[c].row(a.y) + x0;
    for (int i = 0; i < count; ++i) out[i] = in[i];
  }
  if constexpr (kSpread == Spread::kNone) return;
  const float* __restrict in = a.spread_in.row(a.y) + x0;
  float* __restrict out = a.spread_out.row(a.y) + x0;
  for (int i = 0; i < count; ++i) out[i] = in[i];
}

HOLDFAST_INLINE bool is_active(const FilterRow& a, int x) {
  return a.activity == nullptr || a.activity->active(x, a.y, a.activity_zone);
}

/// Where a block that begins at x0 must end at the latest: at its size, and, where rows are copied
/// for taps outside the image, where those begin or end, so that few are.
HOLDFAST_INLINE int last_end(const FilterRow& a, int x0) {
  constexpr int kTile = ActivityMap::kTileWidth;
  const int width = a.guides->view.width;
  const int end = min_of(x0 + kFilterBlock, width);
  if (has_apron(a)) return end;
  const int reach = a.weights.radius * a.step;
  const int first = (reach + kTile - 1) / kTile * kTile, last = (width - reach) / kTile * kTile;
  if (x0 < first) return min_of(end, first);
  return x0 < last ? min_of(end, last) : end;
}

/// The row in blocks: as many neighbouring tiles as fit and are all active, or all at rest.
template <int C, Weights kWeights, Spread kSpread, bool kFootprint>
HOLDFAST_INLINE void filter_row_body(const RowPass& pass) {
  const FilterRow& a = pass.row;
  constexpr int kTile = ActivityMap::kTileWidth;
  FilterBlock block;
  const int width = a.guides->view.width;
  for (int x0 = 0; x0 < width;) {
    const bool active = is_active(a, x0);
    const int limit = last_end(a, x0);
    int end = min_of(x0 + kTile, limit);
    while (end < limit && is_active(a, end) == active) end = min_of(end + kTile, limit);
    if (active)
      filter_block<C, kWeights, kSpread, kFootprint>(pass, x0, end - x0, block);
    else
      copy_block<C, kSpread>(a, x0, end - x0);
    x0 = end;
  }
}

// The combinations that the pipeline uses.
HOLDFAST_INLINE void mean1_body(const RowPass& a) {
  filter_row_body<1, Weights::kKept, Spread::kNone, false>(a);
}
HOLDFAST_INLINE void mean2_body(const RowPass& a) {
  filter_row_body<2, Weights::kKept, Spread::kNone, false>(a);
}
HOLDFAST_INLINE void spread_mean2_body(const RowPass& a) {
  filter_row_body<2, Weights::kKept, Spread::kVariance, false>(a);
}
HOLDFAST_INLINE void footprint_mean2_body(const RowPass& a) {
  filter_row_body<2, Weights::kKept, Spread::kVariance, true>(a);
}
HOLDFAST_INLINE void mean3_body(const RowPass& a) {
  filter_row_body<3, Weights::kGeometry, Spread::kNone, false>(a);
}
HOLDFAST_INLINE void spread_mean4_body(const RowPass& a) {
  filter_row_body<4, Weights::kKept, Spread::kVariance, false>(a);
}
HOLDFAST_INLINE void footprint_mean4_body(const RowPass& a) {
  filter_row_body<4, Weights::kKept, Spread::kVariance, true>(a);
}
HOLDFAST_INLINE void mean7_body(const RowPass& a) {
  filter_row_body<7, Weights::kKept, Spread::kNone, false>(a);
}
HOLDFAST_INLINE void mean8_body(const RowPass& a) {
  filter_row_body<8, Weights::kKept, Spread::kNone, false>(a);
}
HOLDFAST_INLINE void weighted_mean1_body(const RowPass& a) {
  filter_row_body<1, Weights::kKept, Spread::kSamples, false>(a);
}
HOLDFAST_INLINE void footprint_mean1_body(const RowPass& a) {
  filter_row_body<1, Weights::kKept, Spread::kSamples, true>(a);
}
HOLDFAST_INLINE void variance_guided1_body(const RowPass& a) {
  filter_row_body<1, Weights::kLuminance, Spread::kVariance, false>(a);
}
HOLDFAST_INLINE void sample_weighted1_body(const RowPass& a) {
  filter_row_body<1, Weights::kLuminance, Spread::kSamples, false>(a);
}
HOLDFAST_INLINE void variance_guided3_body(const RowPass& a) {
  filter_row_body<3, Weights::kLuminance, Spread::kVariance, false>(a);
}
HOLDFAST_INLINE void sample_weighted3_body(const RowPass& a) {
  filter_row_body<3, Weights::kLuminance, Spread::kSamples, false>(a);
}
HOLDFAST_INLINE void footprint_weighted3_body(const RowPass& a) {
  filter_row_body<3, Weights::kLuminance, Spread::kSamples, true>(a);
}
HOLDFAST_INLINE void footprint_weighted1_body(const RowPass& a) {
  filter_row_body<1, Weights::kLuminance, Spread::kSamples, true>(a);
}

/// Has the weights of the tiles of a row that are active.
void provide_weights(const FilterRow& a) noexcept {
  constexpr int kTile = ActivityMap::kTileWidth;
  assert(a.kept != nullptr && a.weights.radius == 1 && TapWeights::has(a.step));
  const int width = a.guides->view.width;
  for (int x = 0; x < width;) {
    int end = x;
    while (end < width && is_active(a, end)) end += kTile;
    if (end > x) a.kept->provide(*a.guides, a.weights, a.step, x, a.y, min_of(end, width) - x);
    x = end + kTile;
  }
}

HOLDFAST_KERNEL(mean1, RowPass)
HOLDFAST_KERNEL(mean2, RowPass)
HOLDFAST_KERNEL(spread_mean2, RowPass)
HOLDFAST_KERNEL(footprint_mean2, RowPass)
HOLDFAST_KERNEL(mean3, RowPass)
HOLDFAST_KERNEL(spread_mean4, RowPass)
HOLDFAST_KERNEL(footprint_mean4, RowPass)
HOLDFAST_KERNEL(mean7, RowPass)
HOLDFAST_KERNEL(mean8, RowPass)
HOLDFAST_KERNEL(weighted_mean1, RowPass)
HOLDFAST_KERNEL(footprint_mean1, RowPass)
HOLDFAST_KERNEL(variance_guided1, RowPass)
HOLDFAST_KERNEL(sample_weighted1, RowPass)
HOLDFAST_KERNEL(variance_guided3, RowPass)
HOLDFAST_KERNEL(sample_weighted3, RowPass)
HOLDFAST_KERNEL(footprint_weighted1, RowPass)
HOLDFAST_KERNEL(footprint_weighted3, RowPass)

}  // namespace

void filter_row(const FilterRow& row) noexcept {
  if (!row.luminance && row.channels != 3) provide_weights(row);
  RowPass pass{row, {}};
  for (int k = 0; k <= row.weights.radius; ++k)
    pass.log2_kernel[k] = std::log2(row.weights.kernel[k]);
  const bool one = row.channels == 1;
  if (row.luminance) {
    assert(one || row.channels == 3);
    if (row.footprint[0]) return one ? footprint_weighted1(pass) : footprint_weighted3(pass);
    if (row.spread == Spread::kSamples)
      return one ? sample_weighted1(pass) : sample_weighted3(pass);
    return one ? variance_guided1(pass) : variance_guided3(pass);
  }
  if (row.spread == Spread::kSamples)
    return row.footprint[0] ? footprint_mean1(pass) : weighted_mean1(pass);
  if (row.spread == Spread::kNone) switch (row.channels) {
      case 1: return mean1(pass);
      case 2: return mean2(pass);
      case 3: return mean3(pass);
      case 7: return mean7(pass);
      default: assert(row.channels == 8); return mean8(pass);
    }
  if (row.channels == 2) return row.footprint[0] ? footprint_mean2(pass) : spread_mean2(pass);
  assert(row.channels == 4);
  return row.footprint[0] ? footprint_mean4(pass) : spread_mean4(pass);
}

void filter_image(const FilterRow& row) {
  for_each_row(row.guides->view.height, [&](int y) { pass_row(row, y); });
}

}  // namespace holdfast
