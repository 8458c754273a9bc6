#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/gtc/matrix_transform.hpp>

#include "core/frame/light.h"
#include "core/shading/direct_light.h"
#include "tests/core/small_world.h"

namespace holdfast::test {

/// What a point is made of, as a textbook says it.
struct Glossy {
  glm::dvec3 albedo{0.0}, f0{0.0};
  double roughness = 0.0;  ///< 0: no lobe
};

inline double smith(double c, double alpha) {
  const double tan2 = (1.0 - c * c) / (c * c);
  return 0.5 * (std::sqrt(1.0 + alpha * alpha * tan2) - 1.0);
}

/// D G2 / (4 n.v n.l) times Schlick's Fresnel term plus albedo / pi (Walter et al., EGSR 2007), all
/// from the directions themselves; shares no code with the core.
inline glm::dvec3 brdf(const Glossy& m, const glm::dvec3& n, const glm::dvec3& v,
                       const glm::dvec3& l) {
  const double nl = glm::dot(n, l), nv = glm::dot(n, v);
  if (nl <= 0.0 || nv <= 0.0) return glm::dvec3(0.0);
  if (m.roughness == 0.0) return m.albedo / std::numbers::pi;
  const double alpha = m.roughness * m.roughness, a2 = alpha * alpha;
  const glm::dvec3 h = glm::normalize(l + v);
  const double sin2 = glm::dot(glm::cross(n, h), glm::cross(n, h)), nh2 = 1.0 - sin2;
  const double d = a2 / (std::numbers::pi * std::pow(sin2 + nh2 * a2, 2.0));
  const double g = 1.0 / (1.0 + smith(nl, alpha) + smith(nv, alpha));
  const glm::dvec3 fresnel = m.f0 + (1.0 - m.f0) * std::pow(1.0 - glm::dot(h, l), 5.0);
  return m.albedo / std::numbers::pi + fresnel * (d * g / (4.0 * nl * nv));
}

/// The midpoint rule with side x side samples of a light of unit radiance that has an area.
inline glm::dvec3 brute_force(const Light& light, const glm::dmat4& world_from_light,
                              const Glossy& material, const ShadingPoint<double>& point, int side) {
  const bool sphere = light.shape == LightShape::kSphere;
  const double area = light.shape == LightShape::kRectangle
                          ? light.width * light.height
                          : std::numbers::pi * light.radius * light.radius * (sphere ? 4 : 1);
  glm::dvec3 sum(0.0);
  for (int i = 0; i < side; ++i) {
    for (int j = 0; j < side; ++j) {
      const glm::dvec4 local = light_point(light, (i + 0.5) / side, (j + 0.5) / side);
      const glm::dvec3 place(world_from_light * local);
      const glm::dvec3 out = sphere
                                 ? glm::dvec3(world_from_light * glm::dvec4(glm::dvec3(local), 0))
                                 : -glm::dvec3(world_from_light[2]);
      const glm::dvec3 d = place - point.position;
      const glm::dvec3 l = glm::normalize(d);
      const double facing = -glm::dot(glm::normalize(out), l);
      const double cosine = glm::dot(point.normal, l);
      if (facing > 0.0 && cosine > 0.0)
        sum += brdf(material, point.normal, point.to_viewer, l) * cosine * facing / glm::dot(d, d);
    }
  }
  return sum * area / (static_cast<double>(side) * side);
}

/// A point at the origin with normal +Y, seen under this cosine from +X.
inline ShadingPoint<double> point_seen_under(double cosine) {
  ShadingPoint<double> point;
  point.normal = {0, 1, 0};
  point.to_viewer = {std::sqrt(1.0 - cosine * cosine), cosine, 0};
  return point;
}

/// A light at `place` whose -Z looks at `target`.
inline glm::dmat4 aimed(glm::dvec3 place, glm::dvec3 target = glm::dvec3(0)) {
  const glm::dvec3 up =
      std::abs(glm::normalize(place - target).y) > 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  return glm::inverse(glm::lookAt(place, target, up));
}

/// A light of unit emission; `width` is the radius where the shape has one.
inline Light unit_light(LightShape shape, double width, double height = 0) {
  return {0, shape, width, height, width, glm::dvec3(1)};
}

template <class T>
ShadingPoint<T> point_in(const ShadingPoint<double>& p) {
  return {glm::vec<3, T>(p.position), glm::vec<3, T>(p.normal),   glm::vec<3, T>(p.to_viewer),
          glm::vec<3, T>(p.albedo),   glm::vec<3, T>(p.specular), static_cast<T>(p.roughness)};
}

}  // namespace holdfast::test
