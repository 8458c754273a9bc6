#include "core/spatial/guided_filter.h"

#include <cassert>

#include "core/kernels/parallel.h"
#include "core/kernels/variants.h"

namespace holdfast {
namespace {

constexpr int kBlock = ActivityMap::kTileWidth;  // the block's state stays in the first cache

/// Per-pixel terms of a block: the tangent plane, the normal and the running sums.
struct Block {
  float plane_0[kBlock], plane_x[kBlock], plane_y[kBlock];     // times the tap's depth
  float offset_0[kBlock], offset_x[kBlock], offset_y[kBlock];  // added
  float nx[kBlock], ny[kBlock], nz[kBlock];
  float luminance[kBlock], inverse_sigma[kBlock];
  float footprint_xx[kBlock], footprint_xy[kBlock], footprint_yy[kBlock];
  float weight_sum[kBlock], spread_sum[kBlock];
  float sum[kMaxFilterChannels][kBlock];
};

/// The distance of the point at depth d and offset (dx, dy) pixels from the tangent plane, divided
/// by its tolerance, is d (plane_0 + dx plane_x + dy plane_y) + offset_0 + dx offset_x + dy
/// offset_y.
HOLDFAST_INLINE void load_planes(const FilterRow& a, int x0, int count, Block& b) {
  const PixelRays<float>& rays = a.guides->rays;
  const float py = static_cast<float>(a.y) + 0.5f;
  const float l0x = rays.lateral_0.x + py * rays.lateral_y.x;
  const float l0y = rays.lateral_0.y + py * rays.lateral_y.y;
  const float l0z = rays.lateral_0.z + py * rays.lateral_y.z;
  const float lxx = rays.lateral_x.x, lxy = rays.lateral_x.y, lxz = rays.lateral_x.z;
  const float lyx = rays.lateral_y.x, lyy = rays.lateral_y.y, lyz = rays.lateral_y.z;
  const float fx = rays.forward.x, fy = rays.forward.y, fz = rays.forward.z;
  const float near_w = rays.near_weight, far_w = rays.far_weight;
  const float tolerance = a.weights.plane_sigma_px * static_cast<float>(a.step) *
                          static_cast<float>(a.guides->view.pixel_angle);
  const float* __restrict depth = a.guides->depth().row(a.y) + x0;
  const float* __restrict gx = a.guides->normal(0).row(a.y) + x0;
  const float* __restrict gy = a.guides->normal(1).row(a.y) + x0;
  const float* __restrict gz = a.guides->normal(2).row(a.y) + x0;
#pragma GCC ivdep
  for (int i = 0; i < count; ++i) {
    const float d = depth[i] > 0.0f ? depth[i] : 1.0f;
    const float inverse = 1.0f / (tolerance * (near_w + far_w * d));
    const float px = static_cast<float>(x0 + i) + 0.5f;
    const float nx = gx[i], ny = gy[i], nz = gz[i];
    const float n_lateral =
        (nx * (l0x + px * lxx) + ny * (l0y + px * lxy) + nz * (l0z + px * lxz)) * inverse;
    const float n_x = (nx * lxx + ny * lxy + nz * lxz) * inverse;
    const float n_y = (nx * lyx + ny * lyy + nz * lyz) * inverse;
    const float n_forward = (nx * fx + ny * fy + nz * fz) * inverse;
    b.nx[i] = nx;
    b.ny[i] = ny;
    b.nz[i] = nz;
    b.plane_0[i] = far_w * n_lateral + n_forward;
    b.plane_x[i] = far_w * n_x;
    b.plane_y[i] = far_w * n_y;
    b.offset_0[i] = near_w * n_lateral - ((near_w + far_w * d) * n_lateral + d * n_forward);
    b.offset_x[i] = near_w * n_x;
    b.offset_y[i] = near_w * n_y;
  }
}

template <int C, bool kLuminance, Spread kSpread, bool kFootprint>
HOLDFAST_INLINE void add_tap(const FilterRow& a, int x0, int first, int last, int qy, int dx,
                             int dy, float h, Block& b) {
  const float* __restrict depth = a.guides->depth().row(qy) + x0 + dx;
  const float* __restrict gx = a.guides->normal(0).row(qy) + x0 + dx;
  const float* __restrict gy = a.guides->normal(1).row(qy) + x0 + dx;
  const float* __restrict gz = a.guides->normal(2).row(qy) + x0 + dx;
  const float* __restrict lum = kLuminance ? a.luminance.row(qy) + x0 + dx : nullptr;
  const float* __restrict spread = a.spread_in.row(qy) + x0 + dx;
  const float* __restrict in0 = a.in[0].row(qy) + x0 + dx;
  const float* __restrict in1 = C > 1 ? a.in[1].row(qy) + x0 + dx : nullptr;
  const float* __restrict in2 = C > 2 ? a.in[2].row(qy) + x0 + dx : nullptr;
  const float* __restrict in3 = C > 3 ? a.in[3].row(qy) + x0 + dx : nullptr;
  const float* __restrict in4 = C > 4 ? a.in[4].row(qy) + x0 + dx : nullptr;
  const float* __restrict in5 = C > 5 ? a.in[5].row(qy) + x0 + dx : nullptr;
  const float* __restrict in6 = C > 6 ? a.in[6].row(qy) + x0 + dx : nullptr;
  const float normal_power = a.weights.normal_power;
  const float fdx = static_cast<float>(dx), fdy = static_cast<float>(dy);
#pragma GCC ivdep
  for (int i = first; i < last; ++i) {
    const float d = depth[i];
    const float e = d * (b.plane_0[i] + fdx * b.plane_x[i] + fdy * b.plane_y[i]) +
                    (b.offset_0[i] + fdx * b.offset_x[i] + fdy * b.offset_y[i]);
    const float cosine = b.nx[i] * gx[i] + b.ny[i] * gy[i] + b.nz[i] * gz[i];
    float exponent = abs_of(e) + normal_power * max_of(1.0f - cosine, 0.0f);
    if constexpr (kLuminance) exponent += abs_of(lum[i] - b.luminance[i]) * b.inverse_sigma[i];
    if constexpr (kFootprint)
      exponent += fdx * fdx * b.footprint_xx[i] + 2.0f * fdx * fdy * b.footprint_xy[i] +
                  fdy * fdy * b.footprint_yy[i];
    const float g = h * exp_nonpositive(-exponent);
    const float w = kSpread == Spread::kSamples ? g * spread[i] : g;
    b.weight_sum[i] += w;
    b.spread_sum[i] += kSpread == Spread::kSamples ? g * w : w * w * spread[i];
    b.sum[0][i] += w * in0[i];
    if constexpr (C > 1) b.sum[1][i] += w * in1[i];
    if constexpr (C > 2) b.sum[2][i] += w * in2[i];
    if constexpr (C > 3) b.sum[3][i] += w * in3[i];
    if constexpr (C > 4) b.sum[4][i] += w * in4[i];
    if constexpr (C > 5) b.sum[5][i] += w * in5[i];
    if constexpr (C > 6) b.sum[6][i] += w * in6[i];
  }
}

template <int C, bool kLuminance, Spread kSpread, bool kFootprint>
HOLDFAST_INLINE void filter_block(const FilterRow& a, int x0, int count, Block& b) {
  const int width = a.guides->view.width, height = a.guides->view.height;
  load_planes(a, x0, count, b);
  for (int i = 0; i < count; ++i) b.weight_sum[i] = 0.0f;
  for (int i = 0; i < count; ++i) b.spread_sum[i] = 0.0f;
  for (int c = 0; c < C; ++c)
    for (int i = 0; i < count; ++i) b.sum[c][i] = 0.0f;
  if constexpr (kLuminance) {
    const float* __restrict lum = a.luminance.row(a.y) + x0;
    const float* __restrict inverse = a.inverse_luminance_sigma.row(a.y) + x0;
    for (int i = 0; i < count; ++i) b.luminance[i] = lum[i];
    for (int i = 0; i < count; ++i) b.inverse_sigma[i] = inverse[i];
  }
  if constexpr (kFootprint)
    for (int i = 0; i < count; ++i) {
      b.footprint_xx[i] = a.footprint[0].at(x0 + i, a.y);
      b.footprint_xy[i] = a.footprint[1].at(x0 + i, a.y);
      b.footprint_yy[i] = a.footprint[2].at(x0 + i, a.y);
    }
  const int radius = a.weights.radius;
  for (int ky = -radius; ky <= radius; ++ky) {
    const int qy = a.y + ky * a.step;
    if (qy < 0 || qy >= height) continue;
    for (int kx = -radius; kx <= radius; ++kx) {
      const int dx = kx * a.step;
      const int first = max_of(0, -(x0 + dx));
      const int last = min_of(count, width - dx - x0);
      const float h = a.weights.kernel[abs_of(kx)] * a.weights.kernel[abs_of(ky)];
      add_tap<C, kLuminance, kSpread, kFootprint>(a, x0, first, last, qy, dx, ky * a.step, h, b);
    }
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
  for (int c = 0; c < C; ++c)
    for (int i = 0; i < count; ++i) a.out[c].at(x0 + i, a.y) = a.in[c].at(x0 + i, a.y);
  for (int i = 0; i < count; ++i) a.spread_out.at(x0 + i, a.y) = a.spread_in.at(x0 + i, a.y);
}

template <int C, bool kLuminance, Spread kSpread, bool kFootprint>
HOLDFAST_INLINE void filter_row_body(const FilterRow& a) {
  Block block;
  const int width = a.guides->view.width;
  for (int x0 = 0; x0 < width; x0 += kBlock) {
    const int count = min_of(kBlock, width - x0);
    if (a.activity == nullptr || a.activity->active(x0, a.y))
      filter_block<C, kLuminance, kSpread, kFootprint>(a, x0, count, block);
    else
      copy_block<C>(a, x0, count);
  }
}

// The combinations that the pipeline uses.
HOLDFAST_INLINE void mean1_body(const FilterRow& a) {
  filter_row_body<1, false, Spread::kVariance, false>(a);
}
HOLDFAST_INLINE void mean2_body(const FilterRow& a) {
  filter_row_body<2, false, Spread::kVariance, false>(a);
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
    case 2: return mean2(row);
    case 3: return mean3(row);
    case 4: return row.footprint[0] ? footprint_mean4(row) : mean4(row);
    default: assert(row.channels == 7); return mean7(row);
  }
}

void filter_image(const FilterRow& row) {
  for_each_row(row.guides->view.height, [&](int y) {
    FilterRow at_row = row;
    at_row.y = y;
    filter_row(at_row);
  });
}

}  // namespace holdfast
