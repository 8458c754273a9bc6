#include <algorithm>
#include <cmath>

#include "core/oracle/quads.h"

namespace holdfast::oracle {
namespace {

constexpr double kTolerancePx = 2;
constexpr double kNormalPower = 128;
constexpr double kLeastSum = double{1e-3f};
constexpr int kReach = 2;  // half pixels, of what may stand in

/// From the middle of half pixel q to that of pixel p, in half pixels along one axis.
double apart(int p, int q) { return (p + 0.5) / 2 - (q + 0.5); }

/// The negative logarithm of how alike are what pixel (x, y) and half pixel (qx, qy) show.
double difference(const Surfaces& full, const Surfaces& half, int x, int y, int qx, int qy) {
  const glm::dvec3 normal = full.normal_at(x, y);
  const double distance = std::abs(glm::dot(normal, half.position(qx, qy) - full.position(x, y)));
  const double cosine = glm::dot(normal, half.normal_at(qx, qy));
  return distance / (kTolerancePx * full.pixel_width(full.depth.at(x, y))) +
         kNormalPower * std::max(1 - cosine, 0.0);
}

/// The most similar half pixel nearby, those of the same id before all others.
glm::ivec2 most_similar(const Surfaces& full, const Surfaces& half, int x, int y) {
  glm::ivec2 best(x / 2, y / 2);
  bool found = false, best_foreign = false;
  double least = 0;
  for (int qy = y / 2 - kReach; qy <= y / 2 + kReach; ++qy)
    for (int qx = x / 2 - kReach; qx <= x / 2 + kReach; ++qx) {
      if (!half.inside(qx, qy) || !half.any(qx, qy)) continue;
      const bool foreign = full.id(x, y) != half.id(qx, qy);
      const double d = difference(full, half, x, y, qx, qy) +
                       0.5 * (square(apart(x, qx)) + square(apart(y, qy)));
      if (found && (foreign != best_foreign ? foreign : !(d < least))) continue;
      found = true;
      best = {qx, qy};
      best_foreign = foreign;
      least = d;
    }
  return best;
}

void upsample_pixel(const Surfaces& full, const Surfaces& half, const Image& in, int x, int y,
                    Image& out) {
  double weights = 0, sums[3] = {};
  for (int qy = y / 2 - 1; qy <= y / 2 + 1; ++qy)
    for (int qx = x / 2 - 1; qx <= x / 2 + 1; ++qx) {
      if (!half.inside(qx, qy) || !half.any(qx, qy) || half.id(qx, qy) != full.id(x, y)) continue;
      const double tent =
          std::max(1 - std::abs(apart(x, qx)), 0.0) * std::max(1 - std::abs(apart(y, qy)), 0.0);
      const double g = tent * std::exp(-difference(full, half, x, y, qx, qy));
      weights += g;
      for (int c = 0; c < in.channels(); ++c) sums[c] += g * in.at(qx, qy, c);
    }
  if (weights >= kLeastSum) {
    for (int c = 0; c < in.channels(); ++c) out.at(x, y, c) = sums[c] / weights;
    return;
  }
  const glm::ivec2 q = most_similar(full, half, x, y);
  for (int c = 0; c < in.channels(); ++c) out.at(x, y, c) = in.at(q.x, q.y, c);
}

}  // namespace

Image upsample(const Surfaces& full, const Surfaces& half, const Image& in, const Image& beyond) {
  Image out = beyond;
  for_each_pixel(full.width, full.height, [&](int x, int y) {
    if (full.any(x, y)) upsample_pixel(full, half, in, x, y, out);
  });
  return out;
}

}  // namespace holdfast::oracle
