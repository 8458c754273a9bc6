#include "core/shading/fit/lobe_samples.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/shading/ggx.h"

namespace holdfast::fit {
namespace {

glm::dvec3 visible_normal(const glm::dvec3& v, double alpha, double u1, double u2) {
  const glm::dvec3 s = glm::normalize(glm::dvec3(alpha * v.x, 0.0, v.z));
  const glm::dvec3 t1(0.0, 1.0, 0.0), t2 = glm::cross(s, t1);
  const double r = std::sqrt(u1), phi = 2.0 * std::numbers::pi * u2;
  const double p1 = r * std::cos(phi), k = 0.5 * (1.0 + s.z);
  const double p2 = (1.0 - k) * std::sqrt(1.0 - p1 * p1) + k * r * std::sin(phi);
  const glm::dvec3 n = p1 * t1 + p2 * t2 + std::sqrt(std::max(0.0, 1.0 - p1 * p1 - p2 * p2)) * s;
  return glm::normalize(glm::dvec3(alpha * n.x, alpha * n.y, std::max(1e-9, n.z)));
}

}  // namespace

LobeSamples::LobeSamples(double ggx_alpha, double cosine, int side)
    : v(std::sqrt(1.0 - cosine * cosine), 0.0, cosine), alpha(ggx_alpha) {
  for (int i = 0; i < side; ++i) {
    // Strata of u = 1 - (1 - t)^3 are fine where u nears 1: the lobe's far tail.
    const double rest = 1.0 - (i + 0.5) / side, share = 3.0 * rest * rest / (side * side);
    for (int j = 0; j < side; ++j) {
      const double turn = 0.5 * ((j + 0.5) / side - 0.5);  // the half with y > 0
      const glm::dvec3 h = visible_normal(v, alpha, 1.0 - rest * rest * rest, turn);
      const glm::dvec3 l = glm::reflect(-v, h);
      if (l.z <= 0.0) continue;
      // BRDF * cosine over the density G1 D / (4 v.z).
      const double g1 = 1.0 / (1.0 + smith_lambda(v.z, alpha));
      const double g2 = 1.0 / (1.0 + smith_lambda(v.z, alpha) + smith_lambda(l.z, alpha));
      const double weight = g2 / g1 * share;
      magnitude += weight;
      fresnel += weight * std::pow(1.0 - glm::dot(h, v), 5.0);
      points.push_back({l, weight});
    }
  }
  for (LobePoint& point : points) point.weight /= magnitude;
}

}  // namespace holdfast::fit
