#include "core/spatial/half_grid.h"

#include <algorithm>
#include <limits>

#include "core/kernels/parallel.h"
#include "core/kernels/variants.h"

namespace holdfast {
namespace {

constexpr float kMostDepthChange = 0.25f;  // of the depth, where a surface is seen edge-on; ours

/// One channel of a row of half pixels: of four values each, those of the representatives.
template <class T>
struct ChoiceRow {
  const std::uint32_t* chosen;  ///< 0..3
  const T *upper, *lower;       ///< rows of the full image; twice the upper one at its end
  int width;                    ///< of the full image
  T* out;
};

template <class T>
HOLDFAST_INLINE void choose_of_row(const ChoiceRow<T>& a) {
  const std::uint32_t* __restrict chosen = a.chosen;
  const T* __restrict upper = a.upper;
  const T* __restrict lower = a.lower;
  T* __restrict out = a.out;
  const int whole = a.width / 2;
#pragma GCC ivdep
  for (int x = 0; x < whole; ++x) {
    const std::uint32_t k = chosen[x];
    const T left_above = upper[2 * x], right_above = upper[2 * x + 1];
    const T left_below = lower[2 * x], right_below = lower[2 * x + 1];
    const T above = (k & 1u) != 0 ? right_above : left_above;
    const T below = (k & 1u) != 0 ? right_below : left_below;
    out[x] = k >= 2 ? below : above;
  }
  if (a.width % 2 == 1) out[whole] = (chosen[whole] >= 2 ? lower : upper)[2 * whole];
}

HOLDFAST_INLINE void choose_floats_body(const ChoiceRow<float>& a) { choose_of_row(a); }
HOLDFAST_INLINE void choose_words_body(const ChoiceRow<std::uint32_t>& a) { choose_of_row(a); }
HOLDFAST_KERNEL(choose_floats, ChoiceRow<float>)
HOLDFAST_KERNEL(choose_words, ChoiceRow<std::uint32_t>)

/// One channel of a row of half pixels: means of four values each.
struct MeanRow {
  const float* share[HalfGrid::kQuad];
  const float *upper, *lower;  ///< as in ChoiceRow
  int width;                   ///< of the full image
  float* out;
};

HOLDFAST_INLINE void mean_of_row_body(const MeanRow& a) {
  const float* __restrict share0 = a.share[0];
  const float* __restrict share1 = a.share[1];
  const float* __restrict share2 = a.share[2];
  const float* __restrict share3 = a.share[3];
  const float* __restrict upper = a.upper;
  const float* __restrict lower = a.lower;
  float* __restrict out = a.out;
  const int whole = a.width / 2;
#pragma GCC ivdep
  for (int x = 0; x < whole; ++x)
    out[x] = share0[x] * upper[2 * x] + share1[x] * upper[2 * x + 1] + share2[x] * lower[2 * x] +
             share3[x] * lower[2 * x + 1];
  if (a.width % 2 == 0) return;
  // The shares of what is beyond the edge are 0: any pixel will do.
  const float above = upper[2 * whole], below = lower[2 * whole];
  out[whole] =
      share0[whole] * above + share1[whole] * above + share2[whole] * below + share3[whole] * below;
}
HOLDFAST_KERNEL(mean_of_row, MeanRow)

/// Row y of half pixels. The depth of each is that of its representative, and is moved to where the
/// half pixel's own ray meets the representative's tangent plane.
struct MiddleRow {
  PixelRays<float> full, half;
  int y, width;
  const std::uint32_t* chosen;
  const float* normal[3];
  float* depth;
};

HOLDFAST_INLINE void move_to_middle_body(const MiddleRow& a) {
  const std::uint32_t* __restrict chosen = a.chosen;
  const float* __restrict nx = a.normal[0], * __restrict ny = a.normal[1], * __restrict nz = a.normal[2];
  float* __restrict depths = a.depth;
  const float near_weight = a.half.near_weight, far_weight = a.half.far_weight;
  const float fx = a.half.forward.x, fy = a.half.forward.y, fz = a.half.forward.z;
  const float row = static_cast<float>(a.y) + 0.5f, upper = 2.0f * static_cast<float>(a.y) + 0.5f;
  const glm::vec3 h0 = a.half.lateral_0 + row * a.half.lateral_y, hx = a.half.lateral_x;
  const glm::vec3 p0 = a.full.lateral_0 + upper * a.full.lateral_y, px = a.full.lateral_x,
                  py = a.full.lateral_y;
  const float h0x = h0.x, h0y = h0.y, h0z = h0.z, hxx = hx.x, hxy = hx.y, hxz = hx.z;
  const float p0x = p0.x, p0y = p0.y, p0z = p0.z, pxx = px.x, pxy = px.y, pxz = px.z, pyx = py.x,
              pyy = py.y, pyz = py.z;
#pragma GCC ivdep
  for (int x = 0; x < a.width; ++x) {
    const auto k = static_cast<std::int32_t>(chosen[x]);
    const float depth = depths[x];
    const float middle = static_cast<float>(x) + 0.5f;
    const float lateral =
        nx[x] * (h0x + middle * hxx) + ny[x] * (h0y + middle * hxy) + nz[x] * (h0z + middle * hxz);
    const float forward = nx[x] * fx + ny[x] * fy + nz[x] * fz;
    const float at = static_cast<float>(2 * x + (k & 1)) + 0.5f;
    const float below = static_cast<float>(k >> 1);
    const float scale = near_weight + far_weight * depth;
    const float point = nx[x] * (scale * (p0x + at * pxx + below * pyx) + depth * fx) +
                        ny[x] * (scale * (p0y + at * pxy + below * pyy) + depth * fy) +
                        nz[x] * (scale * (p0z + at * pxz + below * pyz) + depth * fz);
    const float found = (point - near_weight * lateral) / (far_weight * lateral + forward);
    const float least = (1.0f - kMostDepthChange) * depth, most = (1.0f + kMostDepthChange) * depth;
    const float kept = found < least ? least : (found > most ? most : found);
    const float moved = abs_of(found) <= std::numeric_limits<float>::max() ? kept : depth;
    depths[x] = depth > 0.0f ? moved : 0.0f;
  }
}

HOLDFAST_KERNEL(move_to_middle, MiddleRow)

/// Row y of the representatives of one channel.
void choose_row(const HalfGrid& grid, const ChannelView<const float>& full, int y, float* out) {
  const int below = std::min(2 * y + 1, full.height - 1);
  choose_floats({grid.representative[0].row(y), full.row(2 * y), full.row(below), full.width, out});
}

void choose_row(const HalfGrid& grid, const ChannelView<const std::uint32_t>& full, int y,
                std::uint32_t* out) {
  const int below = std::min(2 * y + 1, full.height - 1);
  choose_words({grid.representative[0].row(y), full.row(2 * y), full.row(below), full.width, out});
}

}  // namespace

void halve_guides(const Guides& full, const HalfGrid& grid, Guides& half) {
  for_each_row(grid.representative.height(), [&](int y) {
    const int width = grid.representative.width();
    for (int c = 0; c < 4; ++c)
      choose_row(grid, full.depth_normal[c], y, half.depth_normal[c].row(y));
    move_to_middle({full.rays,
                    half.rays,
                    y,
                    width,
                    grid.representative[0].row(y),
                    {half.normal(0).row(y), half.normal(1).row(y), half.normal(2).row(y)},
                    half.depth_normal[0].row(y)});
    choose_row(grid, full.id[0], y, half.id[0].row(y));
    if (half.roughness) choose_row(grid, full.roughness[0], y, half.roughness[0].row(y));
    if (!half.motion) return;
    for (int c = 0; c < 2; ++c) {
      float* motion = half.motion[c].row(y);
      choose_row(grid, full.motion[c], y, motion);
      for (int x = 0; x < width; ++x) motion[x] *= 0.5f;
    }
  });
}

void halve_signal(const Channels<float>& full, int count, const HalfGrid& grid,
                  Channels<float>& half) {
  for_each_row(half.height(), [&](int y) {
    const int below = std::min(2 * y + 1, full.height() - 1);
    MeanRow row{{}, nullptr, nullptr, full.width(), nullptr};
    for (int k = 0; k < HalfGrid::kQuad; ++k) row.share[k] = grid.share[k].row(y);
    for (int c = 0; c < count; ++c) {
      row.upper = full[c].row(2 * y);
      row.lower = full[c].row(below);
      row.out = half[c].row(y);
      mean_of_row(row);
    }
  });
}

void mean_of_quads(const Channels<float>* const (&pixels)[HalfGrid::kQuad], int count,
                   const HalfGrid& grid, Channels<float>& half) {
  for_each_row(half.height(), [&](int y) {
    for (int c = 0; c < count; ++c) {
      float* out = half[c].row(y);
      std::fill_n(out, half.width(), 0.0f);
      for (int k = 0; k < HalfGrid::kQuad; ++k) {
        const float *share = grid.share[k].row(y), *in = (*pixels[k])[c].row(y);
        for (int x = 0; x < half.width(); ++x) out[x] += share[x] * in[x];
      }
    }
  });
}

void halve_plane(const Plane& full, const HalfGrid& grid, Plane& half) {
  for_each_row(grid.representative.height(), [&](int y) {
    for (int c = 0; c < full.channels(); ++c)
      choose_row(grid, full.words(c), y, half.words(c).row(y));
  });
}

}  // namespace holdfast
