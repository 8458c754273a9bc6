#include "client/scenes/light_batch.h"

#include <algorithm>

#include "client/scenes/shadow_ray.h"

namespace holdfast::scenes {

LightBatcher::LightBatcher(const LightState& light, const Surface& surface,
                           const LightTarget& target)
    : light_(light), surface_(surface), target_(target) {
  const auto place = [&](double u, double v) {
    return glm::dvec3(light.world_from_light * light_point(light.light, u, v));
  };
  first_ = glm::vec3(place(0, 0) - surface.origin);
  along_u_ = glm::vec3(place(1, 0) - place(0, 0));
  along_v_ = glm::vec3(place(0, 1) - place(0, 0));
  origin_shift_ = glm::vec3(surface.origin - surface.position);
  normal_ = glm::vec3(surface.normal);
}

void LightBatcher::fill(const float* u, const float* v, LightBatch& out) const {
  if (target_.is_plain_rectangle())
    fill_rectangle(u, v, out);
  else
    fill_any(u, v, out);
}

// The weight is (n.d)+ / |d|^4 with d from the surface to the sample: the height of the surface
// over the light's plane, area, colour and albedo are the same for all samples.
void LightBatcher::fill_rectangle(const float* u, const float* v, LightBatch& out) const {
  for (int i = 0; i < RayBatch::kSize; ++i) {
    const float x = first_.x + u[i] * along_u_.x + v[i] * along_v_.x;
    const float y = first_.y + u[i] * along_u_.y + v[i] * along_v_.y;
    const float z = first_.z + u[i] * along_u_.z + v[i] * along_v_.z;
    out.rays.x[i] = x, out.rays.y[i] = y, out.rays.z[i] = z;
    out.rays.length[i] = 1.0f;
    const float dx = x + origin_shift_.x, dy = y + origin_shift_.y, dz = z + origin_shift_.z;
    const float distance2 = dx * dx + dy * dy + dz * dz;
    const float height = dx * normal_.x + dy * normal_.y + dz * normal_.z;
    out.weight[i] = std::max(0.0f, height) / (distance2 * distance2);
  }
}

void LightBatcher::fill_any(const float* u, const float* v, LightBatch& out) const {
  for (int i = 0; i < RayBatch::kSize; ++i) {
    LightSample sample;
    const glm::dvec2 uv(static_cast<double>(u[i]), static_cast<double>(v[i]));
    out.weight[i] = static_cast<float>(target_.weight(uv, sample));
    const ShadowRay ray = shadow_ray(surface_, sample);
    out.rays.x[i] = static_cast<float>(ray.direction.x);
    out.rays.y[i] = static_cast<float>(ray.direction.y);
    out.rays.z[i] = static_cast<float>(ray.direction.z);
    out.rays.length[i] = static_cast<float>(std::min(ray.length_m, 1e30));
  }
}

}  // namespace holdfast::scenes
