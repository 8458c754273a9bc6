#include "core/spatial/half_grid.h"

#include <algorithm>
#include <cmath>

#include "core/kernels/parallel.h"

namespace holdfast {
namespace {

constexpr float kMostDepthChange = 0.25f;  // of the depth, where a surface is seen edge-on; ours

/// Where the ray of half pixel (x, y) meets the tangent plane of the surface (px, py) of `full`.
float depth_in_the_middle(const Guides& full, int px, int py, const PixelRays<float>& rays, int x,
                          int y) {
  const float depth = full.depth().at(px, py);
  const glm::vec3 n = full.normal_at(px, py);
  const glm::vec3 lateral = rays.lateral_0 + (static_cast<float>(x) + 0.5f) * rays.lateral_x +
                            (static_cast<float>(y) + 0.5f) * rays.lateral_y;
  const float along = rays.far_weight * glm::dot(n, lateral) + glm::dot(n, rays.forward);
  const float offset =
      glm::dot(n, full.position_at(px, py)) - rays.near_weight * glm::dot(n, lateral);
  const float found = offset / along;
  if (!std::isfinite(found)) return depth;
  return std::clamp(found, (1.0f - kMostDepthChange) * depth, (1.0f + kMostDepthChange) * depth);
}

/// Calls body(x, y, px, py) for every pixel of the half image and its representative (px, py).
template <class Body>
void for_each_representative(const HalfGrid& grid, const Body& body) {
  const auto chosen = grid.representative[0];
  for_each_row(chosen.height, [&](int y) {
    for (int x = 0; x < chosen.width; ++x) {
      const auto k = static_cast<int>(chosen.at(x, y));
      body(x, y, 2 * x + k % 2, 2 * y + k / 2);
    }
  });
}

}  // namespace

void halve_guides(const Guides& full, const HalfGrid& grid, Guides& half) {
  for_each_representative(grid, [&](int x, int y, int px, int py) {
    const bool surface = full.depth().at(px, py) > 0.0f;
    half.depth_normal[0].at(x, y) =
        surface ? depth_in_the_middle(full, px, py, half.rays, x, y) : 0.0f;
    for (int axis = 0; axis < 3; ++axis)
      half.depth_normal[1 + axis].at(x, y) = full.normal(axis).at(px, py);
    half.id[0].at(x, y) = full.id[0].at(px, py);
    if (half.roughness) half.roughness[0].at(x, y) = full.roughness[0].at(px, py);
    if (half.motion)
      for (int c = 0; c < 2; ++c) half.motion[c].at(x, y) = 0.5f * full.motion[c].at(px, py);
  });
}

void halve_signal(const Channels<float>& full, int count, const HalfGrid& grid,
                  Channels<float>& half) {
  const int width = full.width(), last_x = width - 1, last_y = full.height() - 1;
  for_each_row(half.height(), [&](int y) {
    // Beyond an odd edge the share is 0: any pixel will do.
    const int below = std::min(2 * y + 1, last_y);
    const float* share[HalfGrid::kQuad];
    for (int k = 0; k < HalfGrid::kQuad; ++k) share[k] = grid.share[k].row(y);
    for (int c = 0; c < count; ++c) {
      const float *upper = full[c].row(2 * y), *lower = full[c].row(below);
      float* out = half[c].row(y);
      const auto mean = [&](int x, int right) {
        return share[0][x] * upper[2 * x] + share[1][x] * upper[right] +
               share[2][x] * lower[2 * x] + share[3][x] * lower[right];
      };
      for (int x = 0; x < width / 2; ++x) out[x] = mean(x, 2 * x + 1);
      if (width % 2 == 1) out[width / 2] = mean(width / 2, last_x);
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
  for (int c = 0; c < full.channels(); ++c) {
    const auto in = full.words(c);
    const auto out = half.words(c);
    for_each_representative(grid,
                            [&](int x, int y, int px, int py) { out.at(x, y) = in.at(px, py); });
  }
}

}  // namespace holdfast
