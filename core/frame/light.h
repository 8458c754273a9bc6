#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <string_view>

#include <glm/glm.hpp>

namespace holdfast {

enum class LightShape : std::uint8_t { kRectangle, kDisk, kSphere, kPoint, kDirectional };

/// What does not change about a light. Sizes in metres, in light space; emits along local -Z.
struct Light {
  std::uint32_t id = 0;
  LightShape shape = LightShape::kRectangle;
  double width = 0;   ///< rectangle: extent along local X
  double height = 0;  ///< rectangle: extent along local Y
  double radius = 0;  ///< disk, sphere: metres; directional: tangent of the angular radius
  /// What it emits, R, G, B, >= 0; 0 where nobody said. Rectangle, disk, sphere: radiance; point:
  /// radiant intensity (radiance * m^2); directional: irradiance of a surface that faces it.
  glm::dvec3 radiance{0.0};
};

/// "rectangle", "disk", "sphere", "point", "directional".
std::string_view light_shape_name(LightShape shape);
std::optional<LightShape> light_shape_from_name(std::string_view name);

/// The light sample (u, v) in [0,1]^2 as a homogeneous point of light space: w = 1 for a place,
/// w = 0 for a direction from the scene towards the light.
///   rectangle    ((u-1/2) width, (v-1/2) height, 0), one-sided, emits along -Z
///   disk         radius sqrt(u) (cos 2 pi v, sin 2 pi v) in the plane z = 0, emits along -Z
///   sphere       z = 1 - 2u, azimuth 2 pi v, times radius
///   point        the origin
///   directional  direction (radius sqrt(u) cos 2 pi v, radius sqrt(u) sin 2 pi v, 1), normalised
template <class T>
glm::vec<4, T> light_point(const Light& light, T u, T v) {
  const T phi = T(2 * std::numbers::pi) * v;
  const T radius = T(light.radius);
  const T r = radius * std::sqrt(u > T(0) ? u : T(0));
  switch (light.shape) {
    case LightShape::kRectangle:
      return {(u - T(0.5)) * T(light.width), (v - T(0.5)) * T(light.height), T(0), T(1)};
    case LightShape::kDisk: return {r * std::cos(phi), r * std::sin(phi), T(0), T(1)};
    case LightShape::kSphere: {
      const T z = T(1) - T(2) * u;
      const T s = z * z < T(1) ? radius * std::sqrt(T(1) - z * z) : T(0);
      return {s * std::cos(phi), s * std::sin(phi), radius * z, T(1)};
    }
    case LightShape::kPoint: return {T(0), T(0), T(0), T(1)};
    case LightShape::kDirectional:
      return {glm::normalize(glm::vec<3, T>(r * std::cos(phi), r * std::sin(phi), T(1))), T(0)};
  }
  return {T(0), T(0), T(0), T(1)};
}

/// The light's half axes in light space, metres: half the width and height of a rectangle, the
/// radius along each axis that a disk, sphere or sun extends in, 0 for a point.
glm::dmat3 light_half_axes(const Light& light);

}  // namespace holdfast
