#include "client/scenes/light_state.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "client/scenes/spherical_rectangle.h"

namespace holdfast::scenes {
namespace {

/// Area in metres^2 per unit (u, v) times the cosine at the light.
double projected_area(const LightState& state, const glm::dvec3& to_light, const glm::dvec3& at) {
  const Light& light = state.light;
  const glm::dvec3 forward = -glm::dvec3(state.world_from_light[2]);
  switch (light.shape) {
    case LightShape::kRectangle:
      return light.width * light.height * std::max(0.0, -glm::dot(forward, to_light));
    case LightShape::kDisk:
      return std::numbers::pi * light.radius * light.radius *
             std::max(0.0, -glm::dot(forward, to_light));
    case LightShape::kSphere: {
      const glm::dvec3 outwards = glm::normalize(at - glm::dvec3(state.world_from_light[3]));
      return 4.0 * std::numbers::pi * light.radius * light.radius *
             std::max(0.0, -glm::dot(outwards, to_light));
    }
    case LightShape::kPoint:
    case LightShape::kDirectional: return 1.0;
  }
  return 0.0;
}

// Farther than this many areas of squared distance, a uniform sample of the area is as good.
constexpr double kNearAreas = 4.0;

}  // namespace

bool LightState::is_delta() const {
  return light.shape == LightShape::kPoint ||
         (light.shape == LightShape::kDirectional && light.radius <= 0.0);
}

std::vector<LightState> lights_at(const Scene& scene, double frame) {
  std::vector<LightState> out;
  for (const SceneLight& light : scene.lights) {
    LightState& state = out.emplace_back();
    state.light = light.light;
    state.world_from_light = light.motion.at(frame).matrix();
    if (frame >= light.from_frame) state.emission = light.emission;
  }
  return out;
}

LightSample sample_light(const LightState& light, const glm::dvec3& point, const glm::dvec2& uv) {
  const glm::dvec4 local = light_point(light.light, uv.x, uv.y);
  const glm::dvec3 place(light.world_from_light * local);
  LightSample sample;
  if (local.w == 0.0) {
    sample.direction = glm::normalize(place);
    sample.distance_m = std::numeric_limits<double>::infinity();
    sample.geometry = 1.0;
    return sample;
  }
  const glm::dvec3 offset = place - point;
  const double distance2 = glm::dot(offset, offset);
  if (distance2 <= 0.0) return sample;
  sample.distance_m = std::sqrt(distance2);
  sample.direction = offset / sample.distance_m;
  sample.geometry = projected_area(light, sample.direction, place) / distance2;
  return sample;
}

LightSample sample_irradiance_of(const LightState& light, const glm::dvec3& point,
                                 const glm::dvec2& uv) {
  if (light.light.shape != LightShape::kRectangle) return sample_light(light, point, uv);
  const glm::dmat3 axes(light.world_from_light);
  const glm::dvec3 centre(light.world_from_light[3]);
  const glm::dvec3 p = glm::transpose(axes) * (point - centre);
  LightSample sample;
  if (p.z >= 0.0) return sample;  // behind the light
  const double x = 0.5 * light.light.width, y = 0.5 * light.light.height;
  const double dx = std::max(0.0, std::abs(p.x) - x), dy = std::max(0.0, std::abs(p.y) - y);
  if (dx * dx + dy * dy + p.z * p.z > kNearAreas * 4.0 * x * y)
    return sample_light(light, point, uv);
  const SphericalRectangle seen(-x - p.x, x - p.x, -y - p.y, y - p.y, -p.z);
  const glm::dvec3 offset = axes * glm::dvec3(seen.at(uv), -p.z);
  sample.distance_m = glm::length(offset);
  sample.direction = offset / sample.distance_m;
  sample.geometry = seen.solid_angle();
  return sample;
}

}  // namespace holdfast::scenes
