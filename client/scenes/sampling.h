#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/glm.hpp>

namespace holdfast::scenes {

/// Rec. 709 luminance of a linear colour.
inline double luminance(const glm::dvec3& c) { return glm::dot(c, {0.2126, 0.7152, 0.0722}); }

/// A rotation whose third column is the unit vector `n` (Duff et al., JCGT 2017).
inline glm::dmat3 frame_around(const glm::dvec3& n) {
  const double sign = std::copysign(1.0, n.z);
  const double a = -1.0 / (sign + n.z);
  const double b = n.x * n.y * a;
  return {glm::dvec3(1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x),
          glm::dvec3(b, sign + n.y * n.y * a, -n.y), n};
}

/// A direction about the unit vector `n` with density cos/pi. `u` in [0,1)^2.
inline glm::dvec3 sample_cosine(const glm::dvec3& n, const glm::dvec2& u) {
  const double r = std::sqrt(u.x), phi = 2.0 * std::numbers::pi * u.y;
  const glm::dvec3 local(r * std::cos(phi), r * std::sin(phi), std::sqrt(1.0 - u.x));
  return glm::normalize(frame_around(n) * local);
}

/// Sample `i` of `side` x `side` strata of the unit square, jittered by `u` in [0,1)^2.
inline glm::dvec2 stratified(int i, int side, const glm::dvec2& u) {
  return {(i % side + u.x) / side, (i / side + u.y) / side};
}

/// The smallest square grid with at least `samples` cells.
inline int strata_side(int samples) {
  return std::max(1, static_cast<int>(std::ceil(std::sqrt(static_cast<double>(samples)))));
}

}  // namespace holdfast::scenes
