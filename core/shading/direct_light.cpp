#include "core/shading/direct_light.h"

#include <array>
#include <cmath>
#include <numbers>

#include "core/kernels/math.h"
#include "core/shading/ggx.h"
#include "core/shading/ltc.h"
#include "core/shading/polygon.h"

namespace holdfast {
namespace {

constexpr double kLeastDistance = 1e-6;   // metres, of a point light
constexpr double kLeastSunRadius = 1e-4;  // tangent; a smaller sun is a single direction

// Sine above a surface's horizon up to which a light does not reach it: rounding puts a light in
// the surface's own plane up to 1e-5 on either side of it (100 m from the camera and 1 m from the
// light), and whether light is 0 decides more than its value (core/history/unlit.h). Ours.
constexpr double kLeastElevation = 1e-4;

// The least share of a light that reaches: a sliver's or a narrow lobe's is a difference of near
// equals, which rounding must not make 0. Less than that of anything that shines. Ours.
constexpr double kLeastShare = 1e-25;

/// Corners of the regular polygon whose area is the unit circle's.
template <class T>
const std::array<glm::vec<2, T>, kDiskCorners>& disk_corners() {
  static const auto corners = [] {
    constexpr double kStep = 2 * std::numbers::pi / kDiskCorners;
    const double radius = std::sqrt(kStep / std::sin(kStep));
    std::array<glm::vec<2, T>, kDiskCorners> out;
    for (int i = 0; i < kDiskCorners; ++i)
      out[static_cast<std::size_t>(i)] = {T(radius * std::cos(kStep * i)),
                                          T(radius * std::sin(kStep * i))};
    return out;
  }();
  return corners;
}

/// The unit vector perpendicular to the unit vector n nearest to v, or any where they are parallel.
template <class T>
glm::vec<3, T> perpendicular(const glm::vec<3, T>& n, const glm::vec<3, T>& v) {
  auto t = v - n * glm::dot(n, v);
  t -= n * glm::dot(n, t);  // what rounding left
  const T length2 = glm::dot(t, t);
  if (length2 > T(1e-10)) return t / std::sqrt(length2);
  const glm::vec<3, T> axis =
      abs_of(n.x) < T(0.6) ? glm::vec<3, T>(1, 0, 0) : glm::vec<3, T>(0, 1, 0);
  return glm::normalize(glm::cross(n, axis));
}

template <class T>
void add_disk(const glm::vec<3, T>& centre, const glm::vec<3, T>& x, const glm::vec<3, T>& y,
              Polygon<T>& out) {
  for (const auto& c : disk_corners<T>()) out.add(centre + c.x * x + c.y * y);
}

/// The light as a polygon seen from `point`; empty where it does not shine.
template <class T>
Polygon<T> polygon_of(const PlacedLight<T>& light, const glm::vec<3, T>& point) {
  Polygon<T> out;
  const glm::vec<3, T> none(0);
  if (light.half_x == none || light.half_y == none) return out;
  const auto offset = light.centre - point;
  switch (light.shape) {
    case LightShape::kRectangle:
    case LightShape::kDisk: {
      if (!(glm::dot(light.forward, offset) < T(0))) break;
      const auto &x = light.half_x, &y = light.half_y;
      if (light.shape == LightShape::kDisk) {
        add_disk(offset, x, y, out);
        break;
      }
      for (const auto& corner : {-x - y, x - y, x + y, y - x}) out.add(offset + corner);
      break;
    }
    case LightShape::kSphere: {
      // Tangents from the point touch the sphere in a circle.
      const T distance2 = glm::dot(offset, offset), cut = square(light.radius) / distance2;
      if (!(cut < T(1))) break;
      const auto direction = offset / std::sqrt(distance2);
      const auto x = perpendicular(direction, glm::vec<3, T>(0, 0, 1));
      const T radius = light.radius * std::sqrt(T(1) - cut);
      add_disk(offset * (T(1) - cut), radius * x, radius * glm::cross(direction, x), out);
      break;
    }
    case LightShape::kDirectional: add_disk(light.centre, light.half_x, light.half_y, out); break;
    case LightShape::kPoint: break;
  }
  return out;
}

template <class T>
Polygon<T> transformed(const glm::mat<3, 3, T>& matrix, Polygon<T> polygon) {
  for (std::size_t i = 0; i < polygon.count; ++i) polygon.corners[i] = matrix * polygon.corners[i];
  return polygon;
}

/// Whether a light that is clipped to the horizon stands above it by more than rounding: a corner
/// does, or, where the light is so near that none does, it covers much of the sky.
template <class T>
bool reaches(const Polygon<T>& light) {
  for (std::size_t i = 0; i < light.count; ++i) {
    const auto& corner = light.corners[i];
    if (corner.z > T(kLeastElevation) * glm::length(corner)) return true;
  }
  return light.count > 0 && cosine_share(light) > T(kLeastElevation);
}

template <class T>
bool is_black(const glm::vec<3, T>& colour) {
  return colour == glm::vec<3, T>(0);
}

template <class T>
glm::vec<3, T> delta_light(const PlacedLight<T>& light, const ShadingPoint<T>& point,
                           const glm::mat<3, 3, T>& tangent_from_frame) {
  const bool is_near = light.shape == LightShape::kPoint;
  const auto offset = is_near ? light.centre - point.position : light.centre;
  const T distance = max_of(glm::length(offset), T(kLeastDistance));
  const auto l = tangent_from_frame * (offset / distance);
  if (!(l.z > T(kLeastElevation))) return glm::vec<3, T>(0);
  auto share = point.albedo * (l.z * T(std::numbers::inv_pi));
  if (!is_black(point.specular)) {
    auto v = tangent_from_frame * point.to_viewer;
    v.z = max_of(v.z, T(kLeastCosine));
    const T magnitude = ltc_lobe(point.roughness, v.z).magnitude;
    share +=
        point.specular * (ggx_lobe(glm::normalize(v), l, lobe_alpha(point.roughness)) / magnitude);
  }
  return light.emission * share * (is_near ? T(1) / square(distance) : T(1));
}

}  // namespace

template <class T>
PlacedLight<T> place_light(const Light& light, const glm::dmat4& frame_from_light) {
  PlacedLight<T> out;
  const glm::dmat3 axes(frame_from_light);
  const glm::dmat3 half = axes * light_half_axes(light);
  const bool is_far = light.shape == LightShape::kDirectional;
  out.shape = light.shape;
  out.is_delta = light.shape == LightShape::kPoint || (is_far && light.radius < kLeastSunRadius);
  out.centre = is_far ? glm::normalize(axes[2]) : glm::dvec3(frame_from_light[3]);
  out.half_x = half[0];
  out.half_y = half[1];
  out.forward = -glm::normalize(axes[2]);
  out.radius = static_cast<T>(light.radius);
  glm::dvec3 emission = light.radiance;
  if (is_far && !out.is_delta) {
    const double r2 = light.radius * light.radius, secant = std::sqrt(1 + r2);
    // 2 pi (1 - 1/secant), without cancellation.
    emission /= 2 * std::numbers::pi * r2 / (secant * (secant + 1));
  }
  out.emission = emission;
  return out;
}

template <class T>
glm::vec<3, T> unshadowed_light(const PlacedLight<T>& light, const ShadingPoint<T>& point) {
  const auto x = perpendicular(point.normal, point.to_viewer);
  const auto tangent_from_frame =
      glm::transpose(glm::mat<3, 3, T>(x, glm::cross(point.normal, x), point.normal));
  if (light.is_delta) return delta_light(light, point, tangent_from_frame);
  const Polygon<T> visible =
      clip_to_horizon(transformed(tangent_from_frame, polygon_of(light, point.position)));
  if (!reaches(visible)) return glm::vec<3, T>(0);
  glm::vec<3, T> share(0);
  if (!is_black(point.albedo)) share = point.albedo * max_of(T(kLeastShare), cosine_share(visible));
  if (!is_black(point.specular)) {
    const LtcLobe<T> lobe = ltc_lobe(point.roughness, glm::dot(point.normal, point.to_viewer));
    const T part = cosine_share(clip_to_horizon(transformed(lobe.cosine_from_lobe, visible)));
    share += point.specular * max_of(T(kLeastShare), min_of(T(1), part / lobe.above_horizon));
  }
  return light.emission * share;
}

template PlacedLight<float> place_light(const Light&, const glm::dmat4&);
template PlacedLight<double> place_light(const Light&, const glm::dmat4&);
template glm::vec<3, float> unshadowed_light(const PlacedLight<float>&, const ShadingPoint<float>&);
template glm::vec<3, double> unshadowed_light(const PlacedLight<double>&,
                                              const ShadingPoint<double>&);

}  // namespace holdfast
