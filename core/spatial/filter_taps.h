#pragma once

#include "core/kernels/math.h"
#include "core/spatial/guided_filter.h"
#include "core/spatial/tangent_planes.h"

/// The taps of guided_filter.cpp, for a block of a row's pixels at once.
namespace holdfast {

inline constexpr int kFilterBlock = 64;  // pixels; the block's state stays in the first cache

/// One row of a pass, and the logarithms of its kernel's weights at distance 0, 1 and 2, which
/// passes with kept weights do not look at.
struct FilterRow {
  const FilterPass& pass;
  int y;
  float log2_kernel[3];
};

/// Per-pixel terms of a block: the tangent plane, the normal (times its power) and the running
/// sums.
struct FilterBlock : TangentPlanes<kFilterBlock> {
  float weight_sum[kFilterBlock], spread_sum[kFilterBlock];
  float sum[kMaxFilterChannels][kFilterBlock];
  const float *luminance, *inverse_sigma;  // of the pixels; null where the pass has none
  const float *footprint_xx, *footprint_xy, *footprint_yy;
};

/// What a tap is weighed by and adds: rows of the images, all at the row of the tap.
struct TapRow {
  const float *depth, *nx, *ny, *nz, *luminance, *spread, *in[kMaxFilterChannels];
  float normal_power;
};

/// What a tap of a pass reads besides signals: geometry where its weights are found, luminance
/// where that stops it.
struct TapReads {
  bool geometry, luminance, spread;
};

/// Whether no tap of a pass reaches beyond the zeros that are beside rows.
HOLDFAST_INLINE bool has_apron(const FilterPass& a) {
  const ChannelView<const float> depth = a.guides->depth();
  return a.weights.radius * a.step <= kApron && depth.stride - depth.width >= kApron;
}

/// Whether all taps of a block lie in columns of the image.
HOLDFAST_INLINE bool is_inside(const FilterPass& a, int x0, int count) {
  const int reach = a.weights.radius * a.step;
  return x0 >= reach && x0 + count + reach <= a.guides->view.width;
}

/// Copies of the rows of a block whose taps reach beyond the image, with zeros there.
template <int kReach>
struct PaddedRows {
  static constexpr int kGroup = 16;  ///< values that are copied at once
  static constexpr int kRoom = kReach + kGroup;
  static constexpr int kRows = 6 + kMaxFilterChannels;
  alignas(64) float values[kRows][kRoom + kFilterBlock + kRoom];
};

/// A row around the block from x0 on, so that it can be read from -reach to count + reach - 1.
template <int kReach>
HOLDFAST_INLINE const float* pad_row(const float* row, int width, int x0, int count, int reach,
                                     float (&to)[2 * PaddedRows<kReach>::kRoom + kFilterBlock]) {
  constexpr int kGroup = PaddedRows<kReach>::kGroup;
  float* const out = to + PaddedRows<kReach>::kRoom;  // the place of x0
  const int before = (reach + kGroup - 1) / kGroup * kGroup;
  const int after = (count + reach + kGroup - 1) / kGroup * kGroup;
  for (int i = -before; i < after; ++i) out[i] = 0.0f;
  const int first = max_of(-x0, -before), last = min_of(width - x0, after);
  for (int i = first; i < last; ++i) out[i] = row[x0 + i];
  return out;
}

/// The row qy at column x0.
template <int C, TapReads kReads>
HOLDFAST_INLINE TapRow tap_row(const FilterPass& a, int x0, int qy) {
  TapRow t{};
  if constexpr (kReads.geometry) {
    t.depth = a.guides->depth().row(qy) + x0;
    t.nx = a.guides->normal(0).row(qy) + x0;
    t.ny = a.guides->normal(1).row(qy) + x0;
    t.nz = a.guides->normal(2).row(qy) + x0;
    t.normal_power = a.weights.normal_power;
  }
  if constexpr (kReads.luminance) t.luminance = a.luminance.row(qy) + x0;
  if constexpr (kReads.spread) t.spread = a.spread_in.row(qy) + x0;
  for (int c = 0; c < C; ++c) t.in[c] = a.in[c].row(qy) + x0;
  return t;
}

/// The same as copies in `padded`, for a block of `count` pixels.
template <int C, TapReads kReads, int kReach>
HOLDFAST_INLINE TapRow padded_tap_row(const FilterPass& a, int x0, int count, int qy,
                                      PaddedRows<kReach>& padded) {
  const int width = a.guides->view.width, reach = a.weights.radius * a.step;
  TapRow t = tap_row<C, kReads>(a, 0, qy);
  auto* room = padded.values;
  if constexpr (kReads.geometry)
    for (const float** row : {&t.depth, &t.nx, &t.ny, &t.nz})
      *row = pad_row<kReach>(*row, width, x0, count, reach, *room++);
  if constexpr (kReads.luminance)
    t.luminance = pad_row<kReach>(t.luminance, width, x0, count, reach, *room++);
  if constexpr (kReads.spread)
    t.spread = pad_row<kReach>(t.spread, width, x0, count, reach, *room++);
  for (int c = 0; c < C; ++c) t.in[c] = pad_row<kReach>(t.in[c], width, x0, count, reach, *room++);
  return t;
}

/// One pixel's terms for the taps of one row.
struct FilterPixel {
  float plane, plane_x, offset, offset_x, nx, ny, nz, luminance, inverse_sigma;
  float footprint, footprint_x, footprint_xx;
};

/// A pixel's running sums.
template <int C>
struct FilterSums {
  float weight, spread, value[C];
};

template <bool kLuminance, bool kFootprint>
HOLDFAST_INLINE FilterPixel load_pixel(const FilterBlock& b, int i, float dy) {
  FilterPixel p;
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
  return p;
}

template <int C>
HOLDFAST_INLINE FilterSums<C> load_sums(const FilterBlock& b, int i) {
  FilterSums<C> s;
  s.weight = b.weight_sum[i];
  s.spread = b.spread_sum[i];
  s.value[0] = b.sum[0][i];
  if constexpr (C > 1) s.value[1] = b.sum[1][i];
  if constexpr (C > 2) s.value[2] = b.sum[2][i];
  if constexpr (C > 3) s.value[3] = b.sum[3][i];
  if constexpr (C > 4) s.value[4] = b.sum[4][i];
  if constexpr (C > 5) s.value[5] = b.sum[5][i];
  if constexpr (C > 6) s.value[6] = b.sum[6][i];
  if constexpr (C > 7) s.value[7] = b.sum[7][i];
  return s;
}

template <int C>
HOLDFAST_INLINE void store_sums(const FilterSums<C>& s, FilterBlock& b, int i) {
  b.weight_sum[i] = s.weight;
  b.spread_sum[i] = s.spread;
  b.sum[0][i] = s.value[0];
  if constexpr (C > 1) b.sum[1][i] = s.value[1];
  if constexpr (C > 2) b.sum[2][i] = s.value[2];
  if constexpr (C > 3) b.sum[3][i] = s.value[3];
  if constexpr (C > 4) b.sum[4][i] = s.value[4];
  if constexpr (C > 5) b.sum[5][i] = s.value[5];
  if constexpr (C > 6) b.sum[6][i] = s.value[6];
  if constexpr (C > 7) b.sum[7][i] = s.value[7];
}

/// Where a tap lies: what the pixel's terms come to there.
struct TapPlace {
  float plane, offset, footprint;
};

template <bool kFootprint>
HOLDFAST_INLINE TapPlace place_of(const FilterPixel& p, float dx) {
  TapPlace at{p.plane + dx * p.plane_x, p.offset + dx * p.offset_x, 0.0f};
  if constexpr (kFootprint) at.footprint = p.footprint + dx * (p.footprint_x + dx * p.footprint_xx);
  return at;
}

template <bool kFootprint>
HOLDFAST_INLINE TapPlace own_place(const FilterPixel& p) {
  return {p.plane, p.offset, kFootprint ? p.footprint : 0.0f};
}

/// Adds the tap at row position `q`, of weight g.
template <int C, Spread kSpread>
HOLDFAST_INLINE void add_weighted(const TapRow& t, int q, float g, FilterSums<C>& s) {
  const float w = kSpread == Spread::kSamples ? g * t.spread[q] : g;
  s.weight += w;
  if constexpr (kSpread != Spread::kNone)
    s.spread += kSpread == Spread::kSamples ? g * w : w * w * t.spread[q];
  s.value[0] += w * t.in[0][q];
  if constexpr (C > 1) s.value[1] += w * t.in[1][q];
  if constexpr (C > 2) s.value[2] += w * t.in[2][q];
  if constexpr (C > 3) s.value[3] += w * t.in[3][q];
  if constexpr (C > 4) s.value[4] += w * t.in[4][q];
  if constexpr (C > 5) s.value[5] += w * t.in[5][q];
  if constexpr (C > 6) s.value[6] += w * t.in[6][q];
  if constexpr (C > 7) s.value[7] += w * t.in[7][q];
}

/// What the weight of the tap at row position `q` falls with, by e to its power.
template <bool kLuminance, bool kFootprint>
HOLDFAST_INLINE float exponent_of(const TapRow& t, int q, const TapPlace& at,
                                  const FilterPixel& p) {
  const float e = t.depth[q] * at.plane + at.offset;
  const float turned = t.normal_power - p.nx * t.nx[q] - p.ny * t.ny[q] - p.nz * t.nz[q];
  float exponent = abs_of(e) + positive_part(turned);
  if constexpr (kLuminance) exponent += abs_of(t.luminance[q] - p.luminance) * p.inverse_sigma;
  if constexpr (kFootprint) exponent += at.footprint;
  return exponent;
}

/// Adds the taps of one row, whose kernel's weights have these bits by distance. All exponents come
/// first, then all weights: a processor looks ahead over some hundred instructions, and a tap is a
/// chain of 40, so that tap after tap it would wait.
template <int C, bool kLuminance, Spread kSpread, bool kFootprint, int kRadius>
HOLDFAST_INLINE void add_row_taps(const TapRow& t, int i, int step, const float (&bits)[3],
                                  const FilterPixel& p, FilterSums<C>& s) {
  if constexpr (kRadius == 0) {
    const TapPlace at = own_place<kFootprint>(p);
    const float weight = weight_exp(bits[0], exponent_of<kLuminance, kFootprint>(t, i, at, p));
    return add_weighted<C, kSpread>(t, i, weight, s);
  }
  const float dx = static_cast<float>(step);
  const int before = i - step, after = i + step, first = before - step, last = after + step;
  float far_before = 0.0f, far_after = 0.0f;
  if constexpr (kRadius > 1)
    far_before =
        exponent_of<kLuminance, kFootprint>(t, first, place_of<kFootprint>(p, -2.0f * dx), p);
  float near_before =
      exponent_of<kLuminance, kFootprint>(t, before, place_of<kFootprint>(p, -dx), p);
  float own = exponent_of<kLuminance, kFootprint>(t, i, own_place<kFootprint>(p), p);
  float near_after = exponent_of<kLuminance, kFootprint>(t, after, place_of<kFootprint>(p, dx), p);
  if constexpr (kRadius > 1)
    far_after = exponent_of<kLuminance, kFootprint>(t, last, place_of<kFootprint>(p, 2.0f * dx), p);
  if constexpr (kRadius > 1) far_before = weight_exp(bits[2], far_before);
  near_before = weight_exp(bits[1], near_before);
  own = weight_exp(bits[0], own);
  near_after = weight_exp(bits[1], near_after);
  if constexpr (kRadius > 1) far_after = weight_exp(bits[2], far_after);
  if constexpr (kRadius > 1) add_weighted<C, kSpread>(t, first, far_before, s);
  add_weighted<C, kSpread>(t, before, near_before, s);
  add_weighted<C, kSpread>(t, i, own, s);
  add_weighted<C, kSpread>(t, after, near_after, s);
  if constexpr (kRadius > 1) add_weighted<C, kSpread>(t, last, far_after, s);
}

}  // namespace holdfast
