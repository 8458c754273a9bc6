#include "core/spatial/half_grid.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/kernels/math.h"
#include "core/kernels/parallel.h"

namespace holdfast {
namespace {

constexpr float kPlaneTolerancePx = 2.0f;  // as for history taps; ours
constexpr float kNormalCosine = 0.9f;      // likewise
constexpr float kMostDepthChange = 0.25f;  // of the depth, where a surface is seen edge-on; ours

/// The quad of half pixel (x, y): its pixels that are inside the image.
struct Quad {
  int x[HalfGrid::kQuad], y[HalfGrid::kQuad];
  bool inside[HalfGrid::kQuad];

  Quad(int half_x, int half_y, int width, int height) {
    for (int k = 0; k < HalfGrid::kQuad; ++k) {
      x[k] = 2 * half_x + k % 2;
      y[k] = 2 * half_y + k / 2;
      inside[k] = x[k] < width && y[k] < height;
    }
  }
};

/// One pixel's surface.
struct Surface {
  float depth = 0;  ///< 0: none
  glm::vec3 point{0}, normal{0};
  std::uint32_t id = 0;
};

bool agree(const Surface& a, const Surface& b, const Guides& guides) {
  if (a.id != b.id || glm::dot(a.normal, b.normal) < kNormalCosine) return false;
  const PixelRays<float>& rays = guides.rays;
  const float width_m = static_cast<float>(guides.view.pixel_angle) *
                        (rays.near_weight + rays.far_weight * std::min(a.depth, b.depth));
  const float twice = std::abs(glm::dot(a.normal + b.normal, a.point - b.point));
  return twice <= 2.0f * kPlaneTolerancePx * width_m;
}

/// The pixels, a bit each, that show the surface of pixel k.
unsigned surface_of(const Surface* pixels, int k, const Guides& guides) {
  unsigned members = 0;
  for (int j = 0; j < HalfGrid::kQuad; ++j)
    if (pixels[j].depth > 0.0f && (j == k || agree(pixels[k], pixels[j], guides)))
      members |= 1u << j;
  return members;
}

void choose(const Guides& guides, int x, int y, HalfGrid& grid) {
  constexpr int kQuad = HalfGrid::kQuad;
  const Quad quad(x, y, guides.view.width, guides.view.height);
  Surface pixels[kQuad];
  for (int k = 0; k < kQuad; ++k) {
    if (!quad.inside[k]) continue;
    pixels[k].depth = guides.depth().at(quad.x[k], quad.y[k]);
    if (!(pixels[k].depth > 0.0f)) continue;
    pixels[k].point = guides.position_at(quad.x[k], quad.y[k]);
    pixels[k].normal = guides.normal_at(quad.x[k], quad.y[k]);
    pixels[k].id = guides.id[0].at(quad.x[k], quad.y[k]);
  }
  int best = 0, most = 0;
  unsigned members = 1;
  for (int k = 0; k < kQuad && most < kQuad; ++k) {
    if (!(pixels[k].depth > 0.0f)) continue;
    const unsigned shown = surface_of(pixels, k, guides);
    const int count = std::popcount(shown);
    if (count < most || (count == most && pixels[k].depth >= pixels[best].depth)) continue;
    best = k;
    most = count;
    members = shown;
  }
  grid.representative[0].at(x, y) = static_cast<std::uint32_t>(best);
  for (int k = 0; k < kQuad; ++k)
    grid.share[k].at(x, y) =
        (members >> k & 1u) != 0 ? 1.0f / static_cast<float>(std::max(most, 1)) : 0.0f;
}

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

void choose_representatives(const Guides& full, HalfGrid& grid) {
  for_each_row(grid.share.height(), [&](int y) {
    for (int x = 0; x < grid.share.width(); ++x) choose(full, x, y, grid);
  });
}

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
