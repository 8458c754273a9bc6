#include "core/frame/light.h"

#include <algorithm>
#include <array>

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

glm::dmat3 light_half_axes(const Light& light) {
  glm::dvec3 half(light.radius, light.radius, 0);
  if (light.shape == LightShape::kRectangle) half = {light.width / 2, light.height / 2, 0};
  if (light.shape == LightShape::kSphere) half.z = light.radius;
  if (light.shape == LightShape::kPoint) half = glm::dvec3(0);
  return {half.x, 0, 0, 0, half.y, 0, 0, 0, half.z};
}

}  // namespace holdfast
