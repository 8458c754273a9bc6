#include "core/motion/shadow_field.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/kernels/parallel.h"
#include "core/motion/shadow_cast.h"
#include "core/motion/shadow_motion.h"

namespace holdfast {
namespace {

// Variance of the filter's footprint, in terms of the light's cast shape and of pixels: wider costs
// sharpness, narrower leaves noise. Ours, tuned on fence and cylinder at two speeds.
constexpr float kCastVariance = 0.5f / 3.0f;  // times half axis^2; a uniform shape has 1/3
constexpr float kPixelVariance = 0.5f;        // px^2

constexpr int kBlockerSearchRadius = 3;  // px; the window of the local means
constexpr int kBlockerSearchSteps = (2 * kBlockerSearchRadius + 1) * (2 * kBlockerSearchRadius + 1);

constexpr float kFarthest = std::numeric_limits<float>::max();

struct SearchStep {
  int x, y;
};

/// The offsets of the search window, nearest first, rows before columns among equals.
const std::array<SearchStep, kBlockerSearchSteps>& search_order() {
  static const auto order = [] {
    std::array<SearchStep, kBlockerSearchSteps> steps{};
    std::size_t k = 0;
    for (int y = -kBlockerSearchRadius; y <= kBlockerSearchRadius; ++y)
      for (int x = -kBlockerSearchRadius; x <= kBlockerSearchRadius; ++x) steps[k++] = {x, y};
    std::stable_sort(steps.begin(), steps.end(), [](const SearchStep& a, const SearchStep& b) {
      return a.x * a.x + a.y * a.y < b.x * b.x + b.y * b.y;
    });
    return steps;
  }();
  return order;
}

}  // namespace

ShadowTracer::ShadowTracer(const Guides& now, const SceneMotion& scene, const Light& light,
                           const BlockerPlanes& planes)
    : now_(now),
      scene_(scene),
      light_(light),
      distance_(planes.distance->channel(0)),
      u_(planes.sample->channel(0)),
      v_(planes.sample->channel(1)),
      id_(planes.id != nullptr ? planes.id->ids() : ChannelView<const std::uint32_t>{}) {
  const SceneMotion::LightMotion motion = scene.light(light.id);
  light_at_rest_ = motion.at_rest;
  relative_from_light_ = glm::mat4(motion.relative_from_light);
  previous_relative_from_light_ = glm::mat4(motion.previous_relative_from_light);
  half_axes_ = glm::mat3(glm::dmat3(motion.relative_from_light) * light_half_axes(light));
  previous_half_axes_ =
      glm::mat3(glm::dmat3(motion.previous_relative_from_light) * light_half_axes(light));
  pixel_ = glm::mat4(now.view.pixel_from_relative);
  previous_pixel_ = glm::mat4(scene.previous_view().pixel_from_relative);
}

inline bool ShadowTracer::blocked(int x, int y) const {
  const float blocker_m = distance_.at(x, y);
  return now_.depth().at(x, y) > 0.0f && blocker_m >= 0.0f && blocker_m <= kFarthest;
}

void ShadowTracer::measure(Channels<float>& out, int first) const {
  const int axes = half_axes_[2] == glm::vec3(0) ? 2 : 3;
  for_each_row(now_.view.height, [&](int y) {
    float light[3][kFollowBlock];
    for (int x = 0; x < now_.view.width; x += kFollowBlock) {
      const BlockPixels pixels(now_, x, y, std::min(kFollowBlock, now_.view.width - x));
      const float light_w = sample_lights(x, y, pixels.count, light);
      const auto to = [&](int channel) { return out[first + channel].row(y) + x; };
      cast_shadows({pixels,
                    distance_.row(y) + x,
                    {light[0], light[1], light[2]},
                    light_w,
                    half_axes_,
                    axes,
                    pixel_,
                    static_cast<float>(y) + 0.5f,
                    kCastVariance,
                    kPixelVariance,
                    to(kFieldValid),
                    to(kFieldRatio),
                    {to(kFieldPrecision), to(kFieldPrecision + 1), to(kFieldPrecision + 2)}});
    }
  });
}

/// Light samples of `count` pixels from (x, y) on, relative to the camera; returns their w. Samples
/// that are not blocked may be left out, as is a block without blocker.
float ShadowTracer::sample_lights(int x, int y, int count, float (*light)[kFollowBlock]) const {
  const float *u = u_.row(y) + x, *v = v_.row(y) + x, *distance = distance_.row(y) + x;
  const bool any = std::any_of(distance, distance + count,
                               [](float d) { return d <= std::numeric_limits<float>::max(); });
  if (!any) return 1.0f;
  if (light_.shape == LightShape::kRectangle) {  // affine in the sample
    const glm::vec4 start = relative_from_light_ * light_point(light_, 0.0f, 0.0f);
    const glm::vec4 along_u = relative_from_light_[0] * static_cast<float>(light_.width);
    const glm::vec4 along_v = relative_from_light_[1] * static_cast<float>(light_.height);
    for (int axis = 0; axis < 3; ++axis)
      for (int i = 0; i < count; ++i)
        light[axis][i] = start[axis] + u[i] * along_u[axis] + v[i] * along_v[axis];
    return 1.0f;
  }
  for (int i = 0; i < count; ++i) {
    const bool near = distance[i] <= std::numeric_limits<float>::max();
    const glm::vec4 point =
        near ? relative_from_light_ * light_point(light_, u[i], v[i]) : glm::vec4(0);
    for (int axis = 0; axis < 3; ++axis) light[axis][i] = point[axis];
  }
  return light_.shape == LightShape::kDirectional ? 0.0f : 1.0f;
}

void ShadowTracer::follow_block(const BlockPixels& pixels, int x, int y, const float* ratio,
                                const std::uint8_t* own, int surface_slot, int occluder_slot,
                                FollowedBlock& out) const {
  const ObjectMotion<float>& surface = scene_.object(surface_slot);
  const ObjectMotion<float>& occluder = scene_.object(occluder_slot);
  if (!surface.traceable || !occluder.traceable) {
    std::fill_n(out.found, pixels.count, 0.0f);
    std::fill_n(out.sweep, pixels.count, kUnknownSweep);
    return;
  }
  float light[3][kFollowBlock], previous[3][kFollowBlock];
  const glm::vec4 centre = light_point(light_, 0.5f, 0.5f);
  glm::vec4 now = relative_from_light_ * centre, before = previous_relative_from_light_ * centre;
  for (int axis = 0; axis < 3; ++axis) {
    std::fill_n(light[axis], pixels.count, now[axis]);
    std::fill_n(previous[axis], pixels.count, before[axis]);
  }
  if (own != nullptr) {
    const float *u = u_.row(y) + x, *v = v_.row(y) + x;
    for (int i = 0; i < pixels.count; ++i) {
      if (!own[i]) continue;
      const glm::vec4 local = light_point(light_, u[i], v[i]);
      now = relative_from_light_ * local;
      before = previous_relative_from_light_ * local;
      for (int axis = 0; axis < 3; ++axis) {
        light[axis][i] = now[axis];
        previous[axis][i] = before[axis];
      }
    }
  }
  holdfast::follow_shadow({pixels,
                           surface,
                           occluder,
                           previous_pixel_,
                           ratio,
                           {light[0], light[1], light[2]},
                           {previous[0], previous[1], previous[2]},
                           centre.w,
                           previous_half_axes_,
                           out});
  if (occluder.appeared) std::fill_n(out.sweep, pixels.count, kAppearedSweep);
}

int ShadowTracer::own_blocker_slot(int x, int y) const {
  return id_ ? scene_.slot_of(id_.at(x, y)) : 0;
}

PixelPoint<float> ShadowTracer::follow_own(int x, int y, float ratio) const {
  return follow(x, y, ratio, u_.at(x, y), v_.at(x, y), own_blocker_slot(x, y));
}

PixelPoint<float> ShadowTracer::follow_borrowed(int x, int y, float ratio) const {
  return follow(x, y, ratio, 0.5f, 0.5f, nearest_blocker_slot(x, y));
}

int ShadowTracer::nearest_blocker_slot(int x, int y) const {
  if (!id_ || (scene_.slot_count() == 1 && !scene_.objects_appeared())) return 0;
  if (blocked(x, y)) return own_blocker_slot(x, y);
  const ChannelView<const float> depth = now_.depth();
  const int width = depth.width, height = depth.height;
  static const auto& order = search_order();
  for (const SearchStep& step : order) {
    const int qx = x + step.x, qy = y + step.y;
    if (qx < 0 || qy < 0 || qx >= width || qy >= height) continue;
    const float blocker_m = distance_.at(qx, qy);
    if (blocker_m >= 0.0f && blocker_m <= kFarthest && depth.at(qx, qy) > 0.0f)
      return own_blocker_slot(qx, qy);
  }
  return 0;
}

bool ShadowTracer::at_rest(int surface_slot, int occluder_slot) const {
  const ObjectMotion<float>& occluder = scene_.object(occluder_slot);
  return light_at_rest_ && scene_.object(surface_slot).at_rest && occluder.at_rest &&
         !occluder.appeared;
}

bool ShadowTracer::moving_blockers_near(int x, int y, int count) const {
  if (!id_) return false;
  if (scene_.objects_appeared()) return true;  // for one frame, rather than look for each of them
  const int first_x = std::max(x - kBlockerSearchRadius, 0);
  const int last_x = std::min(x + count + kBlockerSearchRadius, id_.width);
  const int first_y = std::max(y - kBlockerSearchRadius, 0);
  const int last_y = std::min(y + kBlockerSearchRadius, id_.height - 1);
  std::uint32_t met = 0;
  for (int slot = 1; slot < scene_.slot_count(); ++slot) {
    const std::uint32_t wanted = scene_.id_of(slot);
    for (int qy = first_y; qy <= last_y; ++qy) {
      const std::uint32_t* id = id_.row(qy);
      for (int qx = first_x; qx < last_x; ++qx) met |= id[qx] == wanted ? 1u : 0u;
    }
    if (met != 0) return true;
  }
  return false;
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
