#include "core/oracle/quads.h"

#include <algorithm>
#include <cmath>

namespace holdfast::oracle {
namespace {

constexpr double kPlaneTolerancePx = 2;
constexpr double kNormalCosine = double{0.9f};
constexpr double kMostDepthChange = 0.25;

glm::ivec2 pixel_of(int x, int y, int k) { return {2 * x + k % 2, 2 * y + k / 2}; }

bool shows(const Surfaces& full, const glm::ivec2& p) {
  return full.inside(p.x, p.y) && full.any(p.x, p.y);
}

bool agree(const Surfaces& full, const glm::ivec2& a, const glm::ivec2& b) {
  const glm::dvec3 normal_a = full.normal_at(a.x, a.y), normal_b = full.normal_at(b.x, b.y);
  if (full.id(a.x, a.y) != full.id(b.x, b.y) || glm::dot(normal_a, normal_b) < kNormalCosine)
    return false;
  const double nearer = std::min(full.depth.at(a.x, a.y), full.depth.at(b.x, b.y));
  const double distance = std::abs(
      glm::dot(0.5 * (normal_a + normal_b), full.position(a.x, a.y) - full.position(b.x, b.y)));
  return distance <= kPlaneTolerancePx * full.pixel_width(nearer);
}

void choose(const Surfaces& full, int x, int y, glm::ivec2& shown, Image& share) {
  shown = pixel_of(x, y, 0);
  int most = 0;
  bool member[Quads::kPixels] = {true, false, false, false};
  for (int k = 0; k < Quads::kPixels; ++k) {
    const glm::ivec2 own = pixel_of(x, y, k);
    if (most == Quads::kPixels || !shows(full, own)) continue;
    bool alike[Quads::kPixels];
    int count = 0;
    for (int j = 0; j < Quads::kPixels; ++j) {
      const glm::ivec2 other = pixel_of(x, y, j);
      alike[j] = j == k || (shows(full, other) && agree(full, own, other));
      count += alike[j] ? 1 : 0;
    }
    const bool nearer = full.depth.at(own.x, own.y) < full.depth.at(shown.x, shown.y);
    if (count < most || (count == most && !nearer)) continue;
    most = count;
    shown = own;
    std::copy(std::begin(alike), std::end(alike), std::begin(member));
  }
  for (int k = 0; k < Quads::kPixels; ++k)
    share.at(x, y, k) = member[k] ? 1.0 / std::max(most, 1) : 0.0;
}

/// Where the middle of half pixel (x, y) sees the tangent plane of the surface at `p`.
double depth_in_the_middle(const Surfaces& full, const glm::ivec2& p, const PixelRays<double>& rays,
                           int x, int y) {
  const double depth = full.depth.at(p.x, p.y);
  const glm::dvec3 normal = full.normal_at(p.x, p.y);
  // A position is an affine function of the depth: find where it is in the plane.
  const glm::dvec3 at_0 = rays.position(x + 0.5, y + 0.5, 0.0);
  const glm::dvec3 a_metre = rays.position(x + 0.5, y + 0.5, 1.0) - at_0;
  const double found = glm::dot(normal, full.position(p.x, p.y) - at_0) / glm::dot(normal, a_metre);
  if (!std::isfinite(found)) return depth;
  return std::clamp(found, (1 - kMostDepthChange) * depth, (1 + kMostDepthChange) * depth);
}

}  // namespace

Quads choose_quads(const Surfaces& full) {
  Quads quads;
  quads.width = (full.width + 1) / 2;
  quads.height = (full.height + 1) / 2;
  quads.share = Image(quads.width, quads.height, Quads::kPixels);
  for_each_pixel(quads.width, quads.height, [&](int x, int y) {
    choose(full, x, y, quads.shown.emplace_back(), quads.share);
  });
  return quads;
}

Surfaces halved(const Surfaces& full, const Quads& quads) {
  Surfaces half;
  half.view = full.view.halved();
  half.width = quads.width;
  half.height = quads.height;
  half.depth = Image(half.width, half.height, 1);
  half.normal = Image(half.width, half.height, 3);
  if (full.roughness) half.roughness = half.depth;
  if (full.motion) half.motion = Image(half.width, half.height, 2);
  for_each_pixel(half.width, half.height, [&](int x, int y) {
    const glm::ivec2 p = quads.representative(x, y);
    half.ids.push_back(full.id(p.x, p.y));
    if (full.any(p.x, p.y))
      half.depth.at(x, y) = depth_in_the_middle(full, p, half.view.rays, x, y);
    for (int c = 0; c < 3; ++c) half.normal.at(x, y, c) = full.normal.at(p.x, p.y, c);
    if (full.roughness) half.roughness.at(x, y) = full.roughness.at(p.x, p.y);
    for (int c = 0; c < half.motion.channels(); ++c)
      half.motion.at(x, y, c) = 0.5 * full.motion.at(p.x, p.y, c);
  });
  return half;
}

Plane halved(const Plane& full, const Quads& quads) {
  Plane half(full.id(), quads.width, quads.height);
  for_each_pixel(quads.width, quads.height, [&](int x, int y) {
    const glm::ivec2 p = quads.representative(x, y);
    for (int c = 0; c < full.channels(); ++c) half.words(c).at(x, y) = full.words(c).at(p.x, p.y);
  });
  return half;
}

Image representatives(const Image& full, const Quads& quads) {
  if (!full) return {};
  Image out(quads.width, quads.height, full.channels());
  for_each_pixel(quads.width, quads.height, [&](int x, int y) {
    const glm::ivec2 p = quads.representative(x, y);
    for (int c = 0; c < full.channels(); ++c) out.at(x, y, c) = full.at(p.x, p.y, c);
  });
  return out;
}

Image pixel_of_quads(const Image& full, const Quads& quads, int k) {
  Image out(quads.width, quads.height, full.channels());
  for_each_pixel(quads.width, quads.height, [&](int x, int y) {
    const glm::ivec2 p = pixel_of(x, y, k);
    if (!(quads.share.at(x, y, k) > 0)) return;
    for (int c = 0; c < full.channels(); ++c) out.at(x, y, c) = full.at(p.x, p.y, c);
  });
  return out;
}

Image mean_of_quads(std::span<const DirectedSamples> pixels, const Quads& quads) {
  Image out(quads.width, quads.height, pixels[0].radiance.channels());
  for_each_pixel(quads.width, quads.height, [&](int x, int y) {
    for (int c = 0; c < out.channels(); ++c)
      for (int k = 0; k < Quads::kPixels; ++k)
        out.at(x, y, c) +=
            quads.share.at(x, y, k) * pixels[static_cast<std::size_t>(k)].radiance.at(x, y, c);
  });
  return out;
}

}  // namespace holdfast::oracle
