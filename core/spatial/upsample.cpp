#include "core/spatial/upsample.h"

#include <algorithm>
#include <limits>

#include "core/kernels/parallel.h"
#include "core/kernels/variants.h"
#include "core/spatial/guided_filter.h"
#include "core/spatial/tangent_planes.h"

namespace holdfast {
namespace {

constexpr int kBlock = 64;            // pixels
constexpr float kTolerancePx = 2.0f;  // half pixels are two wide
constexpr float kNormalPower = FilterWeights{}.normal_power;

/// `count` pixels from (x0, y) on.
struct UpsampleBlock {
  const Upsample* pass;
  int x0, count, y;
  float* weights;  ///< the sums of g
};

/// The half pixels to the sides of a block's pixels, the nearer first.
struct Columns {
  int index[2][kBlock];
  float offset[2][kBlock];  ///< of the half pixel's middle from the pixel's, full pixels
  float weight[2][kBlock];  ///< 0 outside the image
};

HOLDFAST_INLINE void load_columns(int x0, int count, int half_width, Columns& c) {
  for (int i = 0; i < count; ++i) {
    const int x = x0 + i, odd = x & 1;
    const int near = x >> 1, far = near + 2 * odd - 1;
    const bool inside = far >= 0 && far < half_width;
    c.index[0][i] = near;
    c.index[1][i] = far < 0 ? 0 : (inside ? far : near);
    c.offset[0][i] = odd != 0 ? -0.5f : 0.5f;
    c.offset[1][i] = odd != 0 ? 1.5f : -1.5f;
    c.weight[0][i] = 0.75f;
    c.weight[1][i] = inside ? 0.25f : 0.0f;
  }
}

/// The running sums of a block, and its pixels' ids.
template <int C>
struct Sums {
  const std::uint32_t* id;
  float* weight;
  float value[C][kBlock];
};

/// Adds the half pixels of row qy, which lies `dy` full pixels below the block and counts hy.
template <int C>
HOLDFAST_INLINE void add_row(const Upsample& pass, const Columns& columns,
                             const TangentPlanes<kBlock>& b, int count, int qy, float dy, float hy,
                             Sums<C>& sums) {
  const Guides& half = *pass.half;
  const float* __restrict depth = half.depth().row(qy);
  const float* __restrict nx = half.normal(0).row(qy);
  const float* __restrict ny = half.normal(1).row(qy);
  const float* __restrict nz = half.normal(2).row(qy);
  const std::uint32_t* __restrict half_id = half.id[0].row(qy);
  const float* __restrict in0 = pass.in[0].row(qy);
  const float* __restrict in1 = pass.in[C / 2].row(qy);
  const float* __restrict in2 = pass.in[C - 1].row(qy);
  for (int side = 0; side < 2; ++side) {
    const int* __restrict index = columns.index[side];
    const float* __restrict offset = columns.offset[side];
    const float* __restrict weight = columns.weight[side];
#pragma GCC ivdep
    for (int i = 0; i < count; ++i) {
      const int q = index[i];
      const float dx = offset[i];
      const float e = depth[q] * (b.plane_0[i] + dx * b.plane_x[i] + dy * b.plane_y[i]) +
                      (b.offset_0[i] + dx * b.offset_x[i] + dy * b.offset_y[i]);
      const float cosine = b.nx[i] * nx[q] + b.ny[i] * ny[q] + b.nz[i] * nz[q];
      const float exponent = abs_of(e) + kNormalPower * max_of(1.0f - cosine, 0.0f);
      const float h = half_id[q] == sums.id[i] ? hy * weight[i] : 0.0f;
      const float g = h * exp_nonpositive(-exponent);
      sums.weight[i] += g;
      sums.value[0][i] += g * in0[q];
      if constexpr (C > 1) sums.value[1][i] += g * in1[q];
      if constexpr (C > 2) sums.value[2][i] += g * in2[q];
    }
  }
}

template <int C>
HOLDFAST_INLINE void upsample_block(const UpsampleBlock& a) {
  const Upsample& pass = *a.pass;
  const int x0 = a.x0, count = a.count, odd = a.y & 1;
  TangentPlanes<kBlock> planes;
  Columns columns;
  Sums<C> sums;
  load_tangent_planes(*pass.full, kTolerancePx, x0, a.y, count, planes);
  load_columns(x0, count, pass.half->view.width, columns);
  sums.id = pass.full->id[0].row(a.y) + x0;
  sums.weight = a.weights;
  for (int i = 0; i < count; ++i) sums.weight[i] = 0.0f;
  for (int c = 0; c < C; ++c)
    for (int i = 0; i < count; ++i) sums.value[c][i] = 0.0f;
  const int near = a.y >> 1, far = near + 2 * odd - 1;
  const float below = odd != 0 ? -0.5f : 0.5f;
  add_row<C>(pass, columns, planes, count, near, below, 0.75f, sums);
  if (far >= 0 && far < pass.half->view.height)
    add_row<C>(pass, columns, planes, count, far, -3.0f * below, 0.25f, sums);
  const float* __restrict depth = pass.full->depth().row(a.y) + x0;
  for (int c = 0; c < C; ++c) {
    const float* __restrict beyond = pass.beyond[c].row(a.y) + x0;
    float* __restrict out = pass.out[c].row(a.y) + x0;
    for (int i = 0; i < count; ++i) {
      const float mean = sums.value[c][i] / max_of(sums.weight[i], 1e-20f);
      out[i] = depth[i] > 0.0f ? mean : beyond[i];
    }
  }
}

HOLDFAST_INLINE void upsample1_body(const UpsampleBlock& a) { upsample_block<1>(a); }
HOLDFAST_INLINE void upsample3_body(const UpsampleBlock& a) { upsample_block<3>(a); }
HOLDFAST_KERNEL(upsample1, UpsampleBlock)
HOLDFAST_KERNEL(upsample3, UpsampleBlock)

/// How unlike half pixel (qx, qy), which shows a surface, is what pixel (x, y) shows.
struct Unlike {
  bool foreign = true;  ///< of another id: more unlike than anything of the same
  float by = std::numeric_limits<float>::infinity();
  bool operator<(const Unlike& other) const {
    return foreign != other.foreign ? other.foreign : by < other.by;
  }
};

Unlike difference(const Upsample& pass, int x, int y, int qx, int qy) {
  const Guides& full = *pass.full;
  const Guides& half = *pass.half;
  const glm::vec3 n = full.normal_at(x, y);
  const float width_m = static_cast<float>(full.view.pixel_angle) *
                        (full.rays.near_weight + full.rays.far_weight * full.depth().at(x, y));
  const float distance = glm::dot(n, half.position_at(qx, qy) - full.position_at(x, y));
  const float dx = static_cast<float>(qx) + 0.5f - 0.5f * (static_cast<float>(x) + 0.5f);
  const float dy = static_cast<float>(qy) + 0.5f - 0.5f * (static_cast<float>(y) + 0.5f);
  return {full.id[0].at(x, y) != half.id[0].at(qx, qy),
          std::abs(distance) / (kTolerancePx * width_m) +
              kNormalPower * std::max(1.0f - glm::dot(n, half.normal_at(qx, qy)), 0.0f) +
              0.5f * (dx * dx + dy * dy)};
}

void take_most_similar(const Upsample& pass, int x, int y) {
  constexpr int kReach = 2;
  const int last_x = pass.half->view.width - 1, last_y = pass.half->view.height - 1;
  const int own_x = x / 2, own_y = y / 2;
  int best_x = own_x, best_y = own_y;
  Unlike least;
  for (int qy = std::max(own_y - kReach, 0); qy <= std::min(own_y + kReach, last_y); ++qy)
    for (int qx = std::max(own_x - kReach, 0); qx <= std::min(own_x + kReach, last_x); ++qx) {
      if (!(pass.half->depth().at(qx, qy) > 0.0f)) continue;
      const Unlike d = difference(pass, x, y, qx, qy);
      if (!(d < least)) continue;
      least = d;
      best_x = qx;
      best_y = qy;
    }
  for (int c = 0; c < pass.channels; ++c) pass.out[c].at(x, y) = pass.in[c].at(best_x, best_y);
}

}  // namespace

void upsample(const Upsample& pass) {
  const int width = pass.full->view.width;
  const auto depth = pass.full->depth();
  for_each_row(pass.full->view.height, [&](int y) {
    float weights[kBlock];
    for (int x0 = 0; x0 < width; x0 += kBlock) {
      const int count = std::min(kBlock, width - x0);
      const UpsampleBlock block{&pass, x0, count, y, weights};
      pass.channels == 1 ? upsample1(block) : upsample3(block);
      for (int i = 0; i < count; ++i)
        if (depth.at(x0 + i, y) > 0.0f && weights[i] < kLeastWeight)
          take_most_similar(pass, x0 + i, y);
    }
  });
}

}  // namespace holdfast
