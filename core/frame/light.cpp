#include "core/frame/light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace holdfast {
namespace {
constexpr std::array<std::string_view, 5> kShapeNames{"rectangle", "disk", "sphere", "point",
                                                      "directional"};
}

std::string_view light_shape_name(LightShape shape) {
  return kShapeNames[static_cast<std::size_t>(shape)];
}

std::optional<LightShape> light_shape_from_name(std::string_view name) {
  const auto it = std::find(kShapeNames.begin(), kShapeNames.end(), name);
  if (it == kShapeNames.end()) return std::nullopt;
  return static_cast<LightShape>(it - kShapeNames.begin());
}

glm::dvec4 light_point(const Light& light, double u, double v) {
  const double phi = 2 * std::numbers::pi * v;
  const double r = light.radius * std::sqrt(std::max(u, 0.0));
  switch (light.shape) {
    case LightShape::kRectangle: return {(u - 0.5) * light.width, (v - 0.5) * light.height, 0, 1};
    case LightShape::kDisk: return {r * std::cos(phi), r * std::sin(phi), 0, 1};
    case LightShape::kSphere: {
      const double z = 1 - 2 * u;
      const double s = light.radius * std::sqrt(std::max(0.0, 1 - z * z));
      return {s * std::cos(phi), s * std::sin(phi), light.radius * z, 1};
    }
    case LightShape::kPoint: return {0, 0, 0, 1};
    case LightShape::kDirectional:
      return {glm::normalize(glm::dvec3(r * std::cos(phi), r * std::sin(phi), 1)), 0};
  }
  return {0, 0, 0, 1};
}

}  // namespace holdfast
