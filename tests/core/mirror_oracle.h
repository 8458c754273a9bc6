#pragma once

#include <limits>

#include <glm/glm.hpp>

#include "core/frame/view_geometry.h"

namespace holdfast::test {

/// The pixel whose ray, reflected by the plane through `surface`, passes through `hit`: found by
/// tracing rays and Newton's method, without the image behind the mirror. All points are relative
/// to the camera.
inline glm::dvec2 pixel_that_sees_reflected(const ViewGeometry& view, const glm::dvec3& surface,
                                            const glm::dvec3& normal, const glm::dvec3& hit) {
  struct Ray {
    glm::dvec3 from, along;
  };
  const auto reflected = [&](glm::dvec2 p) -> Ray {
    const glm::dvec3 along = view.rays.position(p.x, p.y, 1.0);
    const double t = glm::dot(surface, normal) / glm::dot(along, normal);
    return {t * along, glm::reflect(glm::normalize(along), normal) * (t > 0 ? 1.0 : 1e9)};
  };
  // A start near enough: of a coarse grid, the pixel whose ray passes nearest.
  glm::dvec2 p(0);
  double nearest = std::numeric_limits<double>::max();
  for (int y = -view.height; y < 2 * view.height; y += 8)
    for (int x = -view.width; x < 2 * view.width; x += 8) {
      const Ray ray = reflected({x, y});
      const double d = glm::length(glm::cross(hit - ray.from, ray.along));
      if (d < nearest) {
        nearest = d;
        p = {x, y};
      }
    }
  // Where the rays cut a plane through the hit, in coordinates on that plane.
  const glm::dvec3 facing = reflected(p).along;
  const glm::dvec3 a = glm::normalize(glm::cross(facing, glm::dvec3(0.3, 0.2, 0.9)));
  const glm::dvec3 b = glm::normalize(glm::cross(facing, a));
  const auto miss = [&](glm::dvec2 q) {
    const Ray ray = reflected(q);
    const double t = glm::dot(hit - ray.from, facing) / glm::dot(ray.along, facing);
    const glm::dvec3 off = ray.from + t * ray.along - hit;
    return glm::dvec2(glm::dot(off, a), glm::dot(off, b));
  };
  for (int step = 0; step < 30; ++step) {
    const double h = 1e-4;
    const glm::dvec2 f = miss(p);
    const glm::dvec2 dx = (miss(p + glm::dvec2(h, 0)) - miss(p - glm::dvec2(h, 0))) / (2 * h);
    const glm::dvec2 dy = (miss(p + glm::dvec2(0, h)) - miss(p - glm::dvec2(0, h))) / (2 * h);
    p -= glm::inverse(glm::dmat2(dx, dy)) * f;
  }
  return p;
}

}  // namespace holdfast::test
