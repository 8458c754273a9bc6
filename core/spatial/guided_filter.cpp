#include "core/spatial/guided_filter.h"

#include <cassert>

#include "core/kernels/parallel.h"
#include "core/kernels/variants.h"
#include "core/spatial/tangent_planes.h"

namespace holdfast {
namespace {

constexpr int kBlock = 64;  // pixels; the block's state stays in the first cache

/// Per-pixel terms of a block: the tangent plane, the normal and the running sums.
struct Block : TangentPlanes<kBlock> {
  float weight_sum[kBlock], spread_sum[kBlock];
  float sum[kMaxFilterChannels][kBlock];
  const float *luminance, *inverse_sigma;  // of the pixels; null where the pass has none
  const float *footprint_xx, *footprint_xy, *footprint_yy;
};

/// What a tap is weighed by and adds: rows of the images, all at the row of the tap.
struct TapRow {
  const float *depth, *nx, *ny, *nz, *luminance, *spread, *in[kMaxFilterChannels];
  float normal_power;
};

template <int C, bool kLuminance>
HOLDFAST_INLINE TapRow tap_row(const FilterRow& a, int x0, int qy) {
  TapRow t{};
  t.depth = a.guides->depth().row(qy) + x0;
  t.nx = a.guides->normal(0).row(qy) + x0;
  t.ny = a.guides->normal(1).row(qy) + x0;
  t.nz = a.guides->normal(2).row(qy) + x0;
  if constexpr (kLuminance) t.luminance = a.luminance.row(qy) + x0;
  t.spread = a.spread_in.row(qy) + x0;
  for (int c = 0; c < C; ++c) t.in[c] = a.in[c].row(qy) + x0;
  t.normal_power = a.weights.normal_power;
  return t;
}

/// One pixel's terms for the taps of one row, and its running sums.
template <int C>
struct Pixel {
  float plane, plane_x, offset, offset_x, nx, ny, nz, luminance, inverse_sigma;
  float footprint, footprint_x, footprint_xx;
  float weight_sum, spread_sum, sum[C];
};

template <int C, bool kLuminance, bool kFootprint>
HOLDFAST_INLINE Pixel<C> load_pixel(const Block& b, int i, float dy) {
  Pixel<C> p;
  p.plane = b.plane_0[i] + dy * b.plane_y[i];
  p.plane_x = b.plane_x[i];
  p.offset = b.offset_0[i] + dy * b.offset_y[i];
  p.offset_x = b.offset_x[i];
  p.nx = b.nx[i];
  p.ny = b.ny[i];
  p.nz = b.nz[i];
  if constexpr (kLuminance) {
    p.luminance = b.luminance[i];
    p.inverse_sigma = b.inverse_sigma[i];
  }
  if constexpr (kFootprint) {
    p.footprint = dy * dy * b.footprint_yy[i];
    p.footprint_x = 2.0f * dy * b.footprint_xy[i];
    p.footprint_xx = b.footprint_xx[i];
  }
  p.weight_sum = b.weight_sum[i];
  p.spread_sum = b.spread_sum[i];
  p.sum[0] = b.sum[0][i];
  if constexpr (C > 1) p.sum[1] = b.sum[1][i];
  if constexpr (C > 2) p.sum[2] = b.sum[2][i];
  if constexpr (C > 3) p.sum[3] = b.sum[3][i];
  if constexpr (C > 4) p.sum[4] = b.sum[4][i];
  if constexpr (C > 5) p.sum[5] = b.sum[5][i];
  if constexpr (C > 6) p.sum[6] = b.sum[6][i];
  return p;
}

template <int C>
HOLDFAST_INLINE void store_sums(const Pixel<C>& p, Block& b, int i) {
  b.weight_sum[i] = p.weight_sum;
  b.spread_sum[i] = p.spread_sum;
  b.sum[0][i] = p.sum[0];
  if constexpr (C > 1) b.sum[1][i] = p.sum[1];
  if constexpr (C > 2) b.sum[2][i] = p.sum[2];
  if constexpr (C > 3) b.sum[3][i] = p.sum[3];
  if constexpr (C > 4) b.sum[4][i] = p.sum[4];
  if constexpr (C > 5) b.sum[5][i] = p.sum[5];
  if constexpr (C > 6) b.sum[6][i] = p.sum[6];
}

/// Adds the tap at row position `q`, dx pixels from the pixel, of kernel weight h.
template <int C, bool kLuminance, Spread kSpread, bool kFootprint>
HOLDFAST_INLINE void add_tap(const TapRow& t, int q, float dx, float h, Pixel<C>& p) {
  const float e = t.depth[q] * (p.plane + dx * p.plane_x) + (p.offset + dx * p.offset_x);
  const float cosine = p.nx * t.nx[q] + p.ny * t.ny[q] + p.nz * t.nz[q];
  float exponent = abs_of(e) + t.normal_power * max_of(1.0f - cosine, 0.0f);
  if constexpr (kLuminance) exponent += abs_of(t.luminance[q] - p.luminance) * p.inverse_sigma;
  if constexpr (kFootprint) exponent += p.footprint + dx * (p.footprint_x + dx * p.footprint_xx);
  const float g = h * exp_nonpositive(-exponent);
  const float w = kSpread == Spread::kSamples ? g * t.spread[q] : g;
  p.weight_sum += w;
  p.spread_sum += kSpread == Spread::kSamples ? g * w : w * w * t.spread[q];
  p.sum[0] += w * t.in[0][q];
  if constexpr (C > 1) p.sum[1] += w * t.in[1][q];
  if constexpr (C > 2) p.sum[2] += w * t.in[2][q];
  if constexpr (C > 3) p.sum[3] += w * t.in[3][q];
  if constexpr (C > 4) p.sum[4] += w * t.in[4][q];
  if constexpr (C > 5) p.sum[5] += w * t.in[5][q];
  if constexpr (C > 6) p.sum[6] += w * t.in[6][q];
}

/// All taps of one row, for a block whose taps are all inside the image.
template <int C, bool kLuminance, Spread kSpread, bool kFootprint, int kRadius>
HOLDFAST_INLINE void add_taps(const FilterRow& a, int x0, int count, int ky, Block& b) {
  const TapRow t = tap_row<C, kLuminance>(a, x0, a.y + ky * a.step);
  const float dy = static_cast<float>(ky * a.step), dx = static_cast<float>(a.step);
  const float hy = a.weights.kernel[abs_of(ky)];
  const float h0 = hy * a.weights.kernel[0], h1 = hy * a.weights.kernel[1];
  const float h2 = hy * a.weights.kernel[2];
  const int step = a.step;
#pragma GCC ivdep
  for (int i = 0; i < count; ++i) {
    Pixel<C> p = load_pixel<C, kLuminance, kFootprint>(b, i, dy);
    if constexpr (kRadius > 1)
      add_tap<C, kLuminance, kSpread, kFootprint>(t, i - 2 * step, -2.0f * dx, h2, p);
    add_tap<C, kLuminance, kSpread, kFootprint>(t, i - step, -dx, h1, p);
    add_tap<C, kLuminance, kSpread, kFootprint>(t, i, 0.0f, h0, p);
    add_tap<C, kLuminance, kSpread, kFootprint>(t, i + step, dx, h1, p);
    if constexpr (kRadius > 1)
      add_tap<C, kLuminance, kSpread, kFootprint>(t, i + 2 * step, 2.0f * dx, h2, p);
    store_sums<C>(p, b, i);
  }
}

/// The taps of one row that are inside the image, one after the other.
template <int C, bool kLuminance, Spread kSpread, bool kFootprint>
HOLDFAST_INLINE void add_taps_inside(const FilterRow& a, int x0, int count, int ky, Block& b) {
  const TapRow t = tap_row<C, kLuminance>(a, x0, a.y + ky * a.step);
  const float dy = static_cast<float>(ky * a.step);
  for (int kx = -a.weights.radius; kx <= a.weights.radius; ++kx) {
    const int dx = kx * a.step;
    const int first = max_of(0, -(x0 + dx));
    const int last = min_of(count, a.guides->view.width - dx - x0);
    const float h = a.weights.kernel[abs_of(kx)] * a.weights.kernel[abs_of(ky)];
#pragma GCC ivdep
    for (int i = first; i < last; ++i) {
      Pixel<C> p = load_pixel<C, kLuminance, kFootprint>(b, i, dy);
      add_tap<C, kLuminance, kSpread, kFootprint>(t, i + dx, static_cast<float>(dx), h, p);
      store_sums<C>(p, b, i);
    }
  }
}

template <int C, bool kLuminance, Spread kSpread, bool kFootprint>
HOLDFAST_INLINE void filter_block(const FilterRow& a, int x0, int count, Block& b) {
  const int width = a.guides->view.width, height = a.guides->view.height;
  load_tangent_planes(*a.guides, a.weights.plane_sigma_px * static_cast<float>(a.step), x0, a.y,
                      count, b);
  for (int i = 0; i < count; ++i) b.weight_sum[i] = 0.0f;
  for (int i = 0; i < count; ++i) b.spread_sum[i] = 0.0f;
  for (int c = 0; c < C; ++c)
    for (int i = 0; i < count; ++i) b.sum[c][i] = 0.0f;
  if constexpr (kLuminance) {
    b.luminance = a.luminance.row(a.y) + x0;
    b.inverse_sigma = a.inverse_luminance_sigma.row(a.y) + x0;
  }
  if constexpr (kFootprint) {
    b.footprint_xx = a.footprint[0].row(a.y) + x0;
    b.footprint_xy = a.footprint[1].row(a.y) + x0;
    b.footprint_yy = a.footprint[2].row(a.y) + x0;
  }
  // The radii that the pipeline uses, which are therefore those that are made fast.
  const int reach = a.weights.radius * a.step;
  const bool inside = x0 >= reach && x0 + count + reach <= width;
  const bool wide = kLuminance && inside && a.weights.radius == 2;
  const bool narrow = inside && a.weights.radius == 1;
  for (int ky = -a.weights.radius; ky <= a.weights.radius; ++ky) {
    if (a.y + ky * a.step < 0 || a.y + ky * a.step >= height) continue;
    if (narrow) {
      add_taps<C, kLuminance, kSpread, kFootprint, 1>(a, x0, count, ky, b);
      continue;
    }
    if constexpr (kLuminance)
      if (wide) add_taps<C, kLuminance, kSpread, kFootprint, 2>(a, x0, count, ky, b);
    if (!wide) add_taps_inside<C, kLuminance, kSpread, kFootprint>(a, x0, count, ky, b);
  }
  const float* __restrict depth = a.guides->depth().row(a.y) + x0;
  for (int c = 0; c < C; ++c) {
    const float* __restrict in = a.in[c].row(a.y) + x0;
    float* __restrict out = a.out[c].row(a.y) + x0;
    for (int i = 0; i < count; ++i)
      out[i] = depth[i] > 0.0f && b.weight_sum[i] > 0.0f ? b.sum[c][i] / b.weight_sum[i] : in[i];
  }
  const float* __restrict in = a.spread_in.row(a.y) + x0;
  float* __restrict out = a.spread_out.row(a.y) + x0;
  for (int i = 0; i < count; ++i) {
    const float squared = b.weight_sum[i] * b.weight_sum[i];
    const float value =
        kSpread == Spread::kSamples ? squared / b.spread_sum[i] : b.spread_sum[i] / squared;
    out[i] = depth[i] > 0.0f && b.weight_sum[i] > 0.0f ? value : in[i];
  }
}

template <int C>
HOLDFAST_INLINE void copy_block(const FilterRow& a, int x0, int count) {
  for (int c = 0; c < C; ++c) {
    const float* __restrict in = a.in[c].row(a.y) + x0;
    float* __restrict out = a.out[c].row(a.y) + x0;
    for (int i = 0; i < count; ++i) out[i] = in[i];
  }
  const float* __restrict in = a.spread_in.row(a.y) + x0;
  float* __restrict out = a.spread_out.row(a.y) + x0;
  for (int i = 0; i < count; ++i) out[i] = in[i];
}

HOLDFAST_INLINE bool is_active(const FilterRow& a, int x) {
  return a.activity == nullptr || a.activity->active(x, a.y, a.activity_zone);
}

/// The row in blocks: as many neighbouring tiles as fit and are all active, or all at rest.
template <int C, bool kLuminance, Spread kSpread, bool kFootprint>
HOLDFAST_INLINE void filter_row_body(const FilterRow& a) {
  constexpr int kTile = ActivityMap::kTileWidth;
  Block block;
  const int width = a.guides->view.width;
  for (int x0 = 0; x0 < width;) {
    const bool active = is_active(a, x0);
    int end = x0 + kTile;
    while (end < width && end - x0 < kBlock && is_active(a, end) == active) end += kTile;
    end = min_of(end, width);
    if (active)
      filter_block<C, kLuminance, kSpread, kFootprint>(a, x0, end - x0, block);
    else
      copy_block<C>(a, x0, end - x0);
    x0 = end;
  }
}

// The combinations that the pipeline uses.
HOLDFAST_INLINE void mean1_body(const FilterRow& a) {
  filter_row_body<1, false, Spread::kVariance, false>(a);
}
HOLDFAST_INLINE void mean2_body(const FilterRow& a) {
  filter_row_body<2, false, Spread::kVariance, false>(a);
}
HOLDFAST_INLINE void footprint_mean2_body(const FilterRow& a) {
  filter_row_body<2, false, Spread::kVariance, true>(a);
}
HOLDFAST_INLINE void mean3_body(const FilterRow& a) {
  filter_row_body<3, false, Spread::kVariance, false>(a);
}
HOLDFAST_INLINE void mean4_body(const FilterRow& a) {
  filter_row_body<4, false, Spread::kVariance, false>(a);
}
HOLDFAST_INLINE void footprint_mean4_body(const FilterRow& a) {
  filter_row_body<4, false, Spread::kVariance, true>(a);
}
HOLDFAST_INLINE void mean7_body(const FilterRow& a) {
  filter_row_body<7, false, Spread::kVariance, false>(a);
}
HOLDFAST_INLINE void weighted_mean1_body(const FilterRow& a) {
  filter_row_body<1, false, Spread::kSamples, false>(a);
}
HOLDFAST_INLINE void footprint_mean1_body(const FilterRow& a) {
  filter_row_body<1, false, Spread::kSamples, true>(a);
}
HOLDFAST_INLINE void variance_guided1_body(const FilterRow& a) {
  filter_row_body<1, true, Spread::kVariance, false>(a);
}
HOLDFAST_INLINE void sample_weighted1_body(const FilterRow& a) {
  filter_row_body<1, true, Spread::kSamples, false>(a);
}
HOLDFAST_INLINE void variance_guided3_body(const FilterRow& a) {
  filter_row_body<3, true, Spread::kVariance, false>(a);
}
HOLDFAST_INLINE void sample_weighted3_body(const FilterRow& a) {
  filter_row_body<3, true, Spread::kSamples, false>(a);
}
HOLDFAST_INLINE void footprint_weighted3_body(const FilterRow& a) {
  filter_row_body<3, true, Spread::kSamples, true>(a);
}
HOLDFAST_INLINE void footprint_weighted1_body(const FilterRow& a) {
  filter_row_body<1, true, Spread::kSamples, true>(a);
}

HOLDFAST_KERNEL(mean1, FilterRow)
HOLDFAST_KERNEL(mean2, FilterRow)
HOLDFAST_KERNEL(footprint_mean2, FilterRow)
HOLDFAST_KERNEL(mean3, FilterRow)
HOLDFAST_KERNEL(mean4, FilterRow)
HOLDFAST_KERNEL(footprint_mean4, FilterRow)
HOLDFAST_KERNEL(mean7, FilterRow)
HOLDFAST_KERNEL(weighted_mean1, FilterRow)
HOLDFAST_KERNEL(footprint_mean1, FilterRow)
HOLDFAST_KERNEL(variance_guided1, FilterRow)
HOLDFAST_KERNEL(sample_weighted1, FilterRow)
HOLDFAST_KERNEL(variance_guided3, FilterRow)
HOLDFAST_KERNEL(sample_weighted3, FilterRow)
HOLDFAST_KERNEL(footprint_weighted1, FilterRow)
HOLDFAST_KERNEL(footprint_weighted3, FilterRow)

}  // namespace

void filter_row(const FilterRow& row) noexcept {
  const bool one = row.channels == 1;
  if (row.luminance) {
    assert(one || row.channels == 3);
    if (row.footprint[0]) return one ? footprint_weighted1(row) : footprint_weighted3(row);
    if (row.spread == Spread::kSamples) return one ? sample_weighted1(row) : sample_weighted3(row);
    return one ? variance_guided1(row) : variance_guided3(row);
  }
  if (row.spread == Spread::kSamples)
    return row.footprint[0] ? footprint_mean1(row) : weighted_mean1(row);
  switch (row.channels) {
    case 1: return mean1(row);
    case 2: return row.footprint[0] ? footprint_mean2(row) : mean2(row);
    case 3: return mean3(row);
    case 4: return row.footprint[0] ? footprint_mean4(row) : mean4(row);
    default: assert(row.channels == 7); return mean7(row);
  }
}

void filter_image(const FilterRow& row) {
  for_each_row(row.guides->view.height, [&](int y) { pass_row(row, y); });
}

}  // namespace holdfast
