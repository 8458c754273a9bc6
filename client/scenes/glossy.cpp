#include "client/scenes/glossy.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "client/scenes/sampling.h"
#include "core/frame/conventions.h"
#include "core/shading/ltc.h"

namespace holdfast::scenes {
namespace {

constexpr double kSmallestAlpha = 1e-4;  // GGX alpha; rays of smoother surfaces are a mirror's

double alpha_of(double roughness) {
  return std::max(kSmallestAlpha, ggx_alpha_from_roughness(roughness));
}

glm::dvec3 schlick(const glm::dvec3& f0, double cosine) {
  return f0 + (1.0 - f0) * std::pow(1.0 - std::clamp(cosine, 0.0, 1.0), 5.0);
}

/// Smith's Lambda of a direction with cosine `c` to the normal.
double lambda(double c, double alpha) {
  const double c2 = c * c;
  return 0.5 * (std::sqrt(1.0 + alpha * alpha * (1.0 - c2) / c2) - 1.0);
}

/// A normal visible from `v` (tangent space, z up) for GGX alpha.
glm::dvec3 sample_visible_normal(const glm::dvec3& v, double alpha, const glm::dvec2& u) {
  const glm::dvec3 stretched = glm::normalize(glm::dvec3(alpha * v.x, alpha * v.y, v.z));
  const double length2 = stretched.x * stretched.x + stretched.y * stretched.y;
  const glm::dvec3 t1 = length2 > 0.0
                            ? glm::dvec3(-stretched.y, stretched.x, 0.0) / std::sqrt(length2)
                            : glm::dvec3(1.0, 0.0, 0.0);
  const glm::dvec3 t2 = glm::cross(stretched, t1);
  const double r = std::sqrt(u.x), phi = 2.0 * std::numbers::pi * u.y;
  const double p1 = r * std::cos(phi), s = 0.5 * (1.0 + stretched.z);
  const double p2 = (1.0 - s) * std::sqrt(1.0 - p1 * p1) + s * r * std::sin(phi);
  const glm::dvec3 n =
      p1 * t1 + p2 * t2 + std::sqrt(std::max(0.0, 1.0 - p1 * p1 - p2 * p2)) * stretched;
  return glm::normalize(glm::dvec3(alpha * n.x, alpha * n.y, std::max(1e-12, n.z)));
}

}  // namespace

glm::dvec3 evaluate_lobe(const Surface& surface, const glm::dvec3& to_light, double roughness) {
  const double nl = glm::dot(surface.normal, to_light);
  const double nv = std::max(1e-6, glm::dot(surface.normal, surface.to_viewer));
  if (nl <= 0.0) return glm::dvec3(0.0);
  const double alpha = alpha_of(roughness), a2 = alpha * alpha;
  const glm::dvec3 h = glm::normalize(to_light + surface.to_viewer);
  const double nh = glm::dot(surface.normal, h);
  const double d = nh * nh * (a2 - 1.0) + 1.0;
  const double ndf = a2 / (std::numbers::pi * d * d);
  const double g2 = 1.0 / (1.0 + lambda(nl, alpha) + lambda(nv, alpha));
  return schlick(surface.specular, glm::dot(h, to_light)) * (ndf * g2 / (4.0 * nl * nv));
}

glm::dvec3 specular_factor(const Surface& surface) {
  if (!surface.has_lobe()) return glm::dvec3(0.0);
  const LtcLobe<double> lobe =
      ltc_lobe(surface.roughness, glm::dot(surface.normal, surface.to_viewer));
  return glm::max(glm::dvec3(1e-4), directional_albedo(lobe, surface.specular));
}

LobeSample sample_lobe(const Surface& surface, const glm::dvec2& u) {
  LobeSample out;
  if (!surface.has_lobe()) return out;
  const double alpha = alpha_of(surface.roughness);
  const glm::dmat3 world_from_tangent = frame_around(surface.normal);
  glm::dvec3 v = glm::transpose(world_from_tangent) * surface.to_viewer;
  v.z = std::max(v.z, 1e-6);
  const bool mirror = alpha <= kSmallestAlpha;
  const glm::dvec3 h =
      mirror ? glm::dvec3(0, 0, 1) : sample_visible_normal(glm::normalize(v), alpha, u);
  const glm::dvec3 l = glm::reflect(-v, h);
  const glm::dvec3 direction = glm::normalize(world_from_tangent * l);
  if (l.z <= 1e-9 || glm::dot(direction, surface.geometric_normal) <= 0.0) return out;
  const double g1 = 1.0 / (1.0 + lambda(v.z, alpha));
  const double g2 = 1.0 / (1.0 + lambda(v.z, alpha) + lambda(l.z, alpha));
  out.direction = direction;
  out.weight = schlick(surface.specular, glm::dot(h, l)) * (g2 / g1) / specular_factor(surface);
  return out;
}

}  // namespace holdfast::scenes
