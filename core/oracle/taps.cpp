#include "core/oracle/taps.h"

#include <cmath>
#include <limits>

namespace holdfast::oracle {
namespace {

constexpr double kPlaneTolerancePx = 2.0;
constexpr double kNormalCosine = double{0.9f};
constexpr double kLeastWeight = 1e-3;
constexpr double kLeastSum = 0.01;

bool on_plane(const Surfaces& previous, const Receiver& receiver, int x, int y) {
  const double distance =
      std::abs(glm::dot(receiver.normal, previous.position(x, y) - receiver.point));
  return distance <= kPlaneTolerancePx * previous.pixel_width(previous.depth.at(x, y)) &&
         glm::dot(receiver.normal, previous.normal_at(x, y)) >= kNormalCosine;
}

template <class Valid>
Taps nearest(const Surfaces& previous, const glm::dvec2& at, const Valid& valid) {
  const int middle_x = static_cast<int>(std::floor(at.x)),
            middle_y = static_cast<int>(std::floor(at.y));
  double best = std::numeric_limits<double>::infinity();
  Taps taps;
  for (int y = middle_y - 1; y <= middle_y + 1; ++y)
    for (int x = middle_x - 1; x <= middle_x + 1; ++x) {
      const double distance = square(x + 0.5 - at.x) + square(y + 0.5 - at.y);
      if (!(distance < best) || !previous.inside(x, y) || !valid(x, y)) continue;
      best = distance;
      taps = tap_at(x, y);
    }
  return taps;
}

template <class Valid>
Taps bilinear(const Surfaces& previous, const glm::dvec2& at, const Valid& valid) {
  // Further outside than this, no tap can be inside.
  if (!(at.x > -1 && at.y > -1 && at.x < previous.width + 1 && at.y < previous.height + 1))
    return {};
  const double left = std::floor(at.x - 0.5), top = std::floor(at.y - 0.5);
  const double fx = at.x - 0.5 - left, fy = at.y - 0.5 - top;
  Taps taps;
  double sum = 0;
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < 2; ++i) {
      const int x = static_cast<int>(left) + i, y = static_cast<int>(top) + j;
      const double weight = (i == 1 ? fx : 1 - fx) * (j == 1 ? fy : 1 - fy);
      if (weight < kLeastWeight || !previous.inside(x, y) || !valid(x, y)) continue;
      taps.of[taps.count++] = {x, y, weight};
      sum += weight;
    }
  if (!(sum > kLeastSum)) return nearest(previous, at, valid);
  for (int k = 0; k < taps.count; ++k) taps.of[k].weight /= sum;
  return taps;
}

}  // namespace

Taps find_taps(const Surfaces& previous, const glm::dvec2& at, const Receiver& receiver) {
  return bilinear(previous, at, [&](int x, int y) {
    return previous.any(x, y) && previous.id(x, y) == receiver.id &&
           on_plane(previous, receiver, x, y);
  });
}

Taps find_taps_on_any_surface(const Surfaces& previous, const glm::dvec2& at) {
  return bilinear(previous, at, [&](int x, int y) { return previous.any(x, y); });
}

Taps find_similar_taps(const Surfaces& previous, const glm::dvec2& at, const Receiver& receiver,
                       std::uint32_t foreign_id) {
  return bilinear(previous, at, [&](int x, int y) {
    const std::uint32_t id = previous.id(x, y);
    return previous.any(x, y) && (id != foreign_id || id == receiver.id) &&
           on_plane(previous, receiver, x, y);
  });
}

}  // namespace holdfast::oracle
