#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <string_view>

namespace holdfast {

enum class LightShape : std::uint8_t { kRectangle, kDisk, kSphere, kPoint, kDirectional };

/// What does not change about a light. Sizes in metres, in light space; emits along local -Z.
struct Light {
  std::uint32_t id = 0;
  LightShape shape = LightShape::kRectangle;
  double width = 0;   ///< rectangle: extent along local X
  double height = 0;  ///< rectangle: extent along local Y
  double radius = 0;  ///< disk, sphere: metres; directional: tangent of the angular radius
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
glm::dvec4 light_point(const Light& light, double u, double v);

}  // namespace holdfast
