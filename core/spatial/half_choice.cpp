#include <algorithm>

#include "core/kernels/parallel.h"
#include "core/kernels/variants.h"
#include "core/spatial/half_grid.h"

namespace holdfast {
namespace {

constexpr float kPlaneTolerancePx = 2.0f;  // as for history taps; ours
constexpr float kNormalCosine = 0.9f;      // likewise
constexpr int kQuad = HalfGrid::kQuad;
constexpr int kBlock = 64;  // quads

/// Quads of a row from `x` on.
struct ChoiceBlock {
  const Guides& guides;
  HalfGrid& grid;
  int x, y, count;  ///< of half pixels
};

/// The surfaces of the quads of a block; depth 0 where there is none.
struct QuadSurfaces {
  float depth[kQuad][kBlock];
  float normal[kQuad][3][kBlock];
  float point[kQuad][3][kBlock];
  std::uint32_t id[kQuad][kBlock];
};

/// Every other value from `in` on, `last` where the image has ended.
template <class T>
HOLDFAST_INLINE void take_every_other(const T* in, int inside, int count, T last, T* out) {
  for (int i = 0; i < inside; ++i) out[i] = in[2 * i];
  for (int i = inside; i < count; ++i) out[i] = last;
}

HOLDFAST_INLINE void load_surfaces(const ChoiceBlock& a, QuadSurfaces& s) {
  const Guides& guides = a.guides;
  const PixelRays<float>& rays = guides.rays;
  for (int k = 0; k < kQuad; ++k) {
    const int px = 2 * a.x + k % 2, row = 2 * a.y + k / 2;
    const int inside =
        row < guides.view.height ? std::clamp((guides.view.width - px + 1) / 2, 0, a.count) : 0;
    const int py = inside > 0 ? row : 0, from = inside > 0 ? px : 0;
    take_every_other(guides.depth().row(py) + from, inside, a.count, 0.0f, s.depth[k]);
    take_every_other(guides.id[0].row(py) + from, inside, a.count, 0u, s.id[k]);
    for (int axis = 0; axis < 3; ++axis) {
      take_every_other(guides.normal(axis).row(py) + from, inside, a.count, 0.0f,
                       s.normal[k][axis]);
      const float base =
          rays.lateral_0[axis] + (static_cast<float>(row) + 0.5f) * rays.lateral_y[axis];
      const float across = rays.lateral_x[axis], forward = rays.forward[axis];
      const float *depth = s.depth[k], first = static_cast<float>(px) + 0.5f;
      float* point = s.point[k][axis];
#pragma GCC ivdep
      for (int i = 0; i < a.count; ++i) {
        const float scale = rays.near_weight + rays.far_weight * depth[i];
        const float x = first + 2.0f * static_cast<float>(i);
        point[i] = scale * (base + x * across) + depth[i] * forward;
      }
    }
  }
}

/// agree[i] = 1 where pixels k and j of quad i show one surface, else 0.
HOLDFAST_INLINE void compare(const ChoiceBlock& a, const QuadSurfaces& s, int k, int j,
                             float* __restrict agree) {
  const auto angle = static_cast<float>(a.guides.view.pixel_angle);
  const float near_weight = a.guides.rays.near_weight, far_weight = a.guides.rays.far_weight;
  const auto &n = s.normal[k], &m = s.normal[j], &p = s.point[k], &q = s.point[j];
  const float *d = s.depth[k], *e = s.depth[j];
  const std::uint32_t *id = s.id[k], *other = s.id[j];
#pragma GCC ivdep
  for (int i = 0; i < a.count; ++i) {
    const float nearer = min_of(d[i], e[i]);
    const float width_m = angle * (near_weight + far_weight * nearer);
    const float cosine = n[0][i] * m[0][i] + n[1][i] * m[1][i] + n[2][i] * m[2][i];
    const float twice = abs_of((n[0][i] + m[0][i]) * (p[0][i] - q[0][i]) +
                               (n[1][i] + m[1][i]) * (p[1][i] - q[1][i]) +
                               (n[2][i] + m[2][i]) * (p[2][i] - q[2][i]));
    const float surfaces = nearer > 0.0f ? 1.0f : 0.0f;
    const float same_id = id[i] == other[i] ? surfaces : 0.0f;
    const float same_side = cosine < kNormalCosine ? 0.0f : same_id;
    agree[i] = twice <= 2.0f * kPlaneTolerancePx * width_m ? same_side : 0.0f;
  }
}

/// The best of the pixels and how many show its surface; best 0 of 0 where there is none.
HOLDFAST_INLINE void elect(const QuadSurfaces& s, const float (&agree)[kQuad][kQuad][kBlock],
                           int count, float* __restrict best, float* __restrict most) {
#pragma GCC ivdep
  for (int i = 0; i < count; ++i) {
    float chosen = 0.0f, votes = 0.0f, depth = 0.0f;
    for (int k = 0; k < kQuad; ++k) {
      const float own = s.depth[k][i];
      const float given = agree[k][0][i] + agree[k][1][i] + agree[k][2][i] + agree[k][3][i];
      const float nearer = own < depth ? 0.5f : 0.0f;
      const float counted = votes < 4.0f ? given + nearer : 0.0f;  // all four: nothing is better
      const bool better = counted > votes;
      chosen = better ? static_cast<float>(k) : chosen;
      depth = better ? own : depth;
      votes = better ? given : votes;
    }
    best[i] = chosen;
    most[i] = votes;
  }
}

HOLDFAST_INLINE void choose_body(const ChoiceBlock& a) {
  QuadSurfaces s;
  load_surfaces(a, s);
  float agree[kQuad][kQuad][kBlock], best[kBlock], most[kBlock];
  for (int k = 0; k < kQuad; ++k) {
    for (int i = 0; i < a.count; ++i) agree[k][k][i] = s.depth[k][i] > 0.0f ? 1.0f : 0.0f;
    for (int j = k + 1; j < kQuad; ++j) {
      compare(a, s, k, j, agree[k][j]);
      for (int i = 0; i < a.count; ++i) agree[j][k][i] = agree[k][j][i];
    }
  }
  elect(s, agree, a.count, best, most);
  std::uint32_t* representative = a.grid.representative[0].row(a.y) + a.x;
  const int count = a.count;
  for (int i = 0; i < count; ++i)
    representative[i] = static_cast<std::uint32_t>(static_cast<std::int32_t>(best[i]));
  for (int k = 0; k < kQuad; ++k) {
    float* share = a.grid.share[k].row(a.y) + a.x;
    const float first = k == 0 ? 1.0f : 0.0f;
#pragma GCC ivdep
    for (int i = 0; i < a.count; ++i) {
      const float a0 = agree[0][k][i], a1 = agree[1][k][i], a2 = agree[2][k][i],
                  a3 = agree[3][k][i];
      const float from_2 = best[i] == 2.0f ? a2 : a3;
      const float from_1 = best[i] == 1.0f ? a1 : from_2;
      const float member = best[i] == 0.0f ? a0 : from_1;
      share[i] = most[i] > 0.0f ? member / max_of(most[i], 1.0f) : first;
    }
  }
}

HOLDFAST_KERNEL(choose, ChoiceBlock)

}  // namespace

void choose_representatives(const Guides& full, HalfGrid& grid) {
  const int width = grid.share.width();
  for_each_row(grid.share.height(), [&](int y) {
    for (int x = 0; x < width; x += kBlock) choose({full, grid, x, y, std::min(kBlock, width - x)});
  });
}

}  // namespace holdfast
