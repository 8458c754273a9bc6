#include "core/spatial/upsample.h"

#include <algorithm>
#include <limits>

#include "core/kernels/parallel.h"
#include "core/kernels/variants.h"
#include "core/spatial/guided_filter.h"
#include "core/spatial/tangent_planes.h"

namespace holdfast {
namespace {

constexpr int kBlock = 64;              // pixels
constexpr int kHalfBlock = kBlock / 2;  // of either parity, and half pixels below them
constexpr float kTolerancePx = 2.0f;    // half pixels are two wide
constexpr float kNormalPower = FilterWeights{}.normal_power;

/// `count` pixels from (x0, y) on; x0 is even.
struct UpsampleBlock {
  const Upsample* pass;
  int x0, count, y;
  float* weights;  ///< the sums of g
};

/// The pixels of a block, the even ones and the odd ones: of each kind, neighbours have
/// neighbouring half pixels. Beyond the block's end, anything.
struct Pixels {
  float plane_0[2][kHalfBlock], plane_x[2][kHalfBlock], plane_y[2][kHalfBlock];
  float offset_0[2][kHalfBlock], offset_x[2][kHalfBlock], offset_y[2][kHalfBlock];
  float nx[2][kHalfBlock], ny[2][kHalfBlock], nz[2][kHalfBlock];
  std::uint32_t id[2][kHalfBlock];
};

/// Half pixels of a row: those below a block, one before them and one behind. Outside the image
/// there is no surface, which weighs nothing.
struct HalfPixels {
  static constexpr int kRoom = kHalfBlock + 16;
  float depth[kRoom], nx[kRoom], ny[kRoom], nz[kRoom], in[3][kRoom];
  std::uint32_t id[kRoom];
};

template <int C>
struct Sums {
  float weight[2][kHalfBlock], value[C][2][kHalfBlock];
};

template <class T>
HOLDFAST_INLINE void part(const T (&from)[kBlock], T (&to)[2][kHalfBlock]) {
  for (int j = 0; j < kHalfBlock; ++j) {
    to[0][j] = from[2 * j];
    to[1][j] = from[2 * j + 1];
  }
}

HOLDFAST_INLINE void load_pixels(const Guides& full, int x0, int count, int y, Pixels& p) {
  TangentPlanes<kBlock> planes{};
  load_tangent_planes(full, kTolerancePx, x0, y, count, planes);
  for (float* normal : {planes.nx, planes.ny, planes.nz})
    for (int i = 0; i < kBlock; ++i) normal[i] *= kNormalPower;
  std::uint32_t id[kBlock] = {};
  const std::uint32_t* __restrict row = full.id[0].row(y) + x0;
  for (int i = 0; i < count; ++i) id[i] = row[i];
  part(planes.plane_0, p.plane_0);
  part(planes.plane_x, p.plane_x);
  part(planes.plane_y, p.plane_y);
  part(planes.offset_0, p.offset_0);
  part(planes.offset_x, p.offset_x);
  part(planes.offset_y, p.offset_y);
  part(planes.nx, p.nx);
  part(planes.ny, p.ny);
  part(planes.nz, p.nz);
  part(id, p.id);
}

/// The values of a row around the half pixels from q0 on; zeros outside the image.
template <class T>
HOLDFAST_INLINE void copy_around(const T* row, int width, int q0, T (&to)[HalfPixels::kRoom]) {
  for (int i = 0; i < HalfPixels::kRoom; ++i) to[i] = T(0);
  const int first = q0 > 0 ? 0 : 1, end = min_of(kHalfBlock + 2, width - q0 + 1);
  for (int i = first; i < end; ++i) to[i] = row[q0 - 1 + i];
}

template <int C>
HOLDFAST_INLINE void load_half(const Upsample& pass, int q0, int qy, HalfPixels& h) {
  const Guides& half = *pass.half;
  const int width = half.view.width;
  copy_around(half.depth().row(qy), width, q0, h.depth);
  copy_around(half.normal(0).row(qy), width, q0, h.nx);
  copy_around(half.normal(1).row(qy), width, q0, h.ny);
  copy_around(half.normal(2).row(qy), width, q0, h.nz);
  copy_around(half.id[0].row(qy), width, q0, h.id);
  for (int c = 0; c < C; ++c) copy_around(pass.in[c].row(qy), width, q0, h.in[c]);
}

/// Adds to the pixels of one parity the half pixels `at` places behind their own's, of which the
/// first is at 1, and whose middles lie (dx, dy) full pixels away; `bits`: weight_bits of b.
template <int C>
HOLDFAST_INLINE void add_half(const HalfPixels& h, int at, float dx, float dy, float bits,
                              const Pixels& p, int parity, Sums<C>& sums) {
  const float *depth = h.depth + at, *nx = h.nx + at, *ny = h.ny + at, *nz = h.nz + at;
  const std::uint32_t* half_id = h.id + at;
  const float *in0 = h.in[0] + at, *in1 = h.in[C / 2] + at, *in2 = h.in[C - 1] + at;
#pragma GCC ivdep
  for (int j = 0; j < kHalfBlock; ++j) {
    const float plane =
        p.plane_0[parity][j] + dx * p.plane_x[parity][j] + dy * p.plane_y[parity][j];
    const float offset =
        p.offset_0[parity][j] + dx * p.offset_x[parity][j] + dy * p.offset_y[parity][j];
    const float e = depth[j] * plane + offset;
    const float turned =
        kNormalPower - p.nx[parity][j] * nx[j] - p.ny[parity][j] * ny[j] - p.nz[parity][j] * nz[j];
    const float weight = weight_exp(bits, abs_of(e) + positive_part(turned));
    const float g = half_id[j] == p.id[parity][j] ? weight : 0.0f;
    sums.weight[parity][j] += g;
    sums.value[0][parity][j] += g * in0[j];
    if constexpr (C > 1) sums.value[1][parity][j] += g * in1[j];
    if constexpr (C > 2) sums.value[2][parity][j] += g * in2[j];
  }
}

/// Adds row qy, which lies `dy` full pixels below the block; `bits`: of its nearer and farther half
/// pixels.
template <int C>
HOLDFAST_INLINE void add_half_row(const Upsample& pass, int q0, int qy, float dy, float near_bits,
                                  float far_bits, const Pixels& p, Sums<C>& sums) {
  HalfPixels h;
  load_half<C>(pass, q0, qy, h);
  add_half<C>(h, 1, 0.5f, dy, near_bits, p, 0, sums);
  add_half<C>(h, 0, -1.5f, dy, far_bits, p, 0, sums);
  add_half<C>(h, 1, -0.5f, dy, near_bits, p, 1, sums);
  add_half<C>(h, 2, 1.5f, dy, far_bits, p, 1, sums);
}

template <class T>
HOLDFAST_INLINE void join(const T (&from)[2][kHalfBlock], T (&to)[kBlock]) {
  for (int j = 0; j < kHalfBlock; ++j) {
    to[2 * j] = from[0][j];
    to[2 * j + 1] = from[1][j];
  }
}

template <int C>
HOLDFAST_INLINE void upsample_block(const UpsampleBlock& a) {
  const Upsample& pass = *a.pass;
  const int odd = a.y & 1, q0 = a.x0 / 2;
  Pixels pixels;
  load_pixels(*pass.full, a.x0, a.count, a.y, pixels);
  Sums<C> sums{};
  // Of 9, 3, 3 and 1 sixteenths.
  const float most = weight_bits(-0.830074999f), some = weight_bits(-2.415037499f),
              least = weight_bits(-4.0f);
  const int near = a.y >> 1, far = near + 2 * odd - 1;
  const float below = odd != 0 ? -0.5f : 0.5f;
  add_half_row<C>(pass, q0, near, below, most, some, pixels, sums);
  if (far >= 0 && far < pass.half->view.height)
    add_half_row<C>(pass, q0, far, -3.0f * below, some, least, pixels, sums);
  float weight[kBlock], value[kBlock];
  join(sums.weight, weight);
  for (int i = 0; i < a.count; ++i) a.weights[i] = weight[i];
  const float* __restrict depth = pass.full->depth().row(a.y) + a.x0;
  for (int c = 0; c < C; ++c) {
    const float* __restrict beyond = pass.beyond[c].row(a.y) + a.x0;
    float* __restrict out = pass.out[c].row(a.y) + a.x0;
    join(sums.value[c], value);
    for (int i = 0; i < a.count; ++i) {
      const float mean = value[i] / max_of(weight[i], 1e-20f);
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
