#include "core/motion/shadow_field.h"

#include <algorithm>
#include <cmath>

#include "core/kernels/parallel.h"
#include "core/motion/shadow_motion.h"

namespace holdfast {
namespace {

// Variance of the filter's footprint, in terms of the light's cast shape and of pixels: wider costs
// sharpness, narrower leaves noise. Ours, tuned on fence and cylinder at two speeds.
constexpr float kCastVariance = 0.5f / 3.0f;  // times half axis^2; a uniform shape has 1/3
constexpr float kPixelVariance = 0.5f;        // px^2

constexpr int kBlockerSearchRadius = 3;  // px; the window of the local means

}  // namespace

ShadowTracer::ShadowTracer(const Guides& now, const SceneMotion& scene, const Light& light,
                           const BlockerPlanes& planes)
    : now_(now),
      scene_(scene),
      light_(light),
      distance_(planes.distance->channel(0)),
      u_(planes.sample->channel(0)),
      v_(planes.sample->channel(1)),
      id_(planes.id) {
  const SceneMotion::LightMotion motion = scene.light(light.id);
  relative_from_light_ = glm::mat4(motion.relative_from_light);
  previous_relative_from_light_ = glm::mat4(motion.previous_relative_from_light);
  half_axes_ = glm::mat3(glm::dmat3(motion.relative_from_light) * light_half_axes(light));
  pixel_ = glm::mat4(now.view.pixel_from_relative);
  previous_pixel_ = glm::mat4(scene.previous_view().pixel_from_relative);
}

bool ShadowTracer::blocked(int x, int y) const {
  const float blocker_m = distance_.at(x, y);
  return now_.depth().at(x, y) > 0.0f && blocker_m >= 0.0f && std::isfinite(blocker_m);
}

void ShadowTracer::measure(Channels<float>& out, int first) const {
  for_each_row(now_.view.height, [&](int y) {
    for (int x = 0; x < now_.view.width; ++x) {
      float field[kEffectFieldChannels] = {};
      if (blocked(x, y)) {
        const glm::vec4 light =
            relative_from_light_ * light_point(light_, u_.at(x, y), v_.at(x, y));
        const glm::vec3 point = now_.position_at(x, y), normal = now_.normal_at(x, y);
        const glm::vec3 to_light = glm::vec3(light) - light.w * point;
        const float light_m = glm::length(to_light);
        if (glm::dot(to_light, normal) > 1e-4f * light_m) {
          const float ratio = distance_.at(x, y) / light_m;
          const float beyond = std::max(1.0f - light.w * ratio, 1e-3f);  // blocker to light
          const glm::vec3 precision =
              penumbra_precision(point, normal, -beyond * to_light, ratio / beyond);
          field[kFieldValid] = 1.0f;
          field[kFieldRatio] = ratio;
          for (int k = 0; k < 3; ++k) field[kFieldPrecision + k] = precision[k];
        }
      }
      for (int c = 0; c < kEffectFieldChannels; ++c) out[first + c].at(x, y) = field[c];
    }
  });
}

/// A light's half axis A moves the shadow point by tau (-A + (A.n) t / (t.n)), where t = blocker -
/// light and tau = receiver distance / |t|, both along the ray.
glm::vec3 ShadowTracer::penumbra_precision(const glm::vec3& point, const glm::vec3& normal,
                                           const glm::vec3& towards, float tau) const {
  const auto origin = project(pixel_, point);
  const glm::vec3 slide = towards / glm::dot(towards, normal);
  float xx = kPixelVariance, xy = 0, yy = kPixelVariance;
  for (int k = 0; k < 3; ++k) {
    const glm::vec3 shift = tau * (glm::dot(half_axes_[k], normal) * slide - half_axes_[k]);
    const auto moved = project(pixel_, point + shift);
    if (!moved.in_front) continue;
    const float dx = moved.x - origin.x, dy = moved.y - origin.y;
    xx += kCastVariance * dx * dx;
    xy += kCastVariance * dx * dy;
    yy += kCastVariance * dy * dy;
  }
  return precision_of_covariance(xx, xy, yy);
}

PixelPoint<float> ShadowTracer::follow_own(int x, int y, float ratio) const {
  const int slot = id_ != nullptr ? scene_.slot_of(id_->ids().at(x, y)) : 0;
  return follow(x, y, ratio, u_.at(x, y), v_.at(x, y), slot);
}

PixelPoint<float> ShadowTracer::follow_borrowed(int x, int y, float ratio) const {
  return follow(x, y, ratio, 0.5f, 0.5f, nearest_blocker_slot(x, y));
}

int ShadowTracer::nearest_blocker_slot(int x, int y) const {
  if (id_ == nullptr || scene_.slot_count() == 1) return 0;
  int slot = 0, best = 1 << 20;
  for (int j = -kBlockerSearchRadius; j <= kBlockerSearchRadius; ++j)
    for (int i = -kBlockerSearchRadius; i <= kBlockerSearchRadius; ++i) {
      const int qx = x + i, qy = y + j, distance = i * i + j * j;
      if (distance >= best || qx < 0 || qy < 0 || qx >= now_.view.width || qy >= now_.view.height ||
          !blocked(qx, qy))
        continue;
      best = distance;
      slot = scene_.slot_of(id_->ids().at(qx, qy));
    }
  return slot;
}

PixelPoint<float> ShadowTracer::follow(int x, int y, float ratio, float u, float v,
                                       int occluder_slot) const {
  constexpr PixelPoint<float> kNone{0, 0, 0, false};
  const ObjectMotion<float>& surface = scene_.object(scene_.slot_of(now_.id[0].at(x, y)));
  const ObjectMotion<float>& occluder = scene_.object(occluder_slot);
  if (!surface.traceable || !occluder.traceable) return kNone;
  const glm::vec4 local = light_point(light_, u, v);
  const glm::vec4 light = relative_from_light_ * local;
  const glm::vec3 point = now_.position_at(x, y);
  const glm::vec3 blocker = point + ratio * (glm::vec3(light) - light.w * point);
  const ShadowSample<float> sample{glm::vec3(surface.carry * glm::vec4(point, 1.0f)),
                                   glm::normalize(surface.rotate * now_.normal_at(x, y)),
                                   glm::vec3(occluder.carry * glm::vec4(blocker, 1.0f)),
                                   previous_relative_from_light_ * local};
  glm::vec3 hit;
  if (!shadow_previous_point(sample, hit)) return kNone;
  return project(previous_pixel_, hit);
}

}  // namespace holdfast
