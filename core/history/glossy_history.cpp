#include "core/history/glossy_history.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/frame/conventions.h"
#include "core/history/surface_history.h"
#include "core/kernels/parallel.h"
#include "core/kernels/random.h"
#include "core/motion/glossy_motion.h"

namespace holdfast {
namespace {

/// One reflection, carried to the previous frame.
struct Reflection {
  glm::vec3 point;         ///< s_i, relative to the current camera
  glm::vec4 hit;           ///< h_i, the same; a direction for sky
  glm::vec4 previous_hit;  ///< T_h^-1 h_i, relative to the previous camera
  Receiver receiver;       ///< T_s^-1 s_i and its normal
  float hit_m;
  bool at_rest;  ///< camera, surface and hit: the image has not moved, whatever rounding says
};

class GlossyTracer {
 public:
  GlossyTracer(const FramePair& frames, const GlossyPlanes& planes, GlossyRule rule,
               const FrameKey& key)
      : now_(frames.now),
        previous_(frames.previous),
        scene_(frames.scene),
        planes_(planes),
        rule_(rule),
        frame_key_(mix_bits(key.seed ^ mix_bits(static_cast<std::uint64_t>(key.frame)))),
        pixel_(frames.now.view.pixel_from_relative),
        previous_pixel_(frames.previous.view.pixel_from_relative) {}

  void trace(int x, int y, EffectHistory& out) const {
    Reflection r;
    if (!reflection_at(x, y, r)) return out.set(x, y, {}, 0, 0, 0);
    const float roughness = now_.roughness_at(x, y);
    const auto centre = project(previous_pixel_,
                                virtual_image(r.previous_hit, r.receiver.point, r.receiver.normal));
    if (rule_ == GlossyRule::kStochastic && centre.in_front) {
      const glm::vec2 offset = sample_offset(x, y, r, roughness);
      if (try_pixel(x, y, centre.x + offset.x, centre.y + offset.y, r.receiver, roughness, out))
        return;
    }
    if (rule_ != GlossyRule::kRelative) {
      if (centre.in_front && try_pixel(x, y, centre.x, centre.y, r.receiver, roughness, out))
        return;
      return out.set(x, y, {}, 0, 0, 0);
    }
    trace_relative(x, y, r, roughness, centre, out);
  }

 private:
  bool reflection_at(int x, int y, Reflection& r) const {
    if (!(now_.depth().at(x, y) > 0.0f)) return false;
    const glm::vec3 direction(planes_.direction->channel(0).at(x, y),
                              planes_.direction->channel(1).at(x, y),
                              planes_.direction->channel(2).at(x, y));
    const float length = glm::length(direction);
    r.hit_m = planes_.distance->channel(0).at(x, y);
    if (!(length > 0.0f) || !std::isfinite(length) || !(r.hit_m >= 0.0f)) return false;
    const int slot = planes_.id != nullptr ? scene_.slot_of(planes_.id->ids().at(x, y)) : 0;
    const ObjectMotion<float>& surface = scene_.object(scene_.slot_of(now_.id[0].at(x, y)));
    const ObjectMotion<float>& hit = scene_.object(slot);
    if (!surface.traceable || !hit.traceable) return false;
    r.at_rest = surface.at_rest && hit.at_rest;
    r.point = now_.position_at(x, y);
    r.receiver = previous_receiver(now_, surface, x, y);
    if (std::isfinite(r.hit_m)) {
      r.hit = glm::vec4(r.point + (r.hit_m / length) * direction, 1.0f);
      r.previous_hit = hit.carry * r.hit;
    } else {
      r.hit = r.previous_hit = glm::vec4(direction / length, 0.0f);
    }
    return true;
  }

  void trace_relative(int x, int y, const Reflection& r, float roughness,
                      const PixelPoint<float>& centre, EffectHistory& out) const {
    const auto image =
        r.at_rest ? centre : project(pixel_, virtual_image(r.hit, r.point, now_.normal_at(x, y)));
    if (centre.in_front && image.in_front &&
        try_pixel(x, y, static_cast<float>(x) + 0.5f + (centre.x - image.x),
                  static_cast<float>(y) + 0.5f + (centre.y - image.y), r.receiver, roughness, out))
      return;
    out.set(x, y, {}, 0, 0, 0);
  }

  GlossySpread<float> spread_of(const Reflection& r, float roughness) const {
    const float view_m = glm::length(r.receiver.point);
    const float cosine =
        std::abs(glm::dot(r.receiver.point, r.receiver.normal)) / std::max(view_m, 1e-20f);
    return glossy_spread(1.0f / static_cast<float>(previous_.view.pixel_angle),
                         ggx_alpha_from_roughness(roughness), view_m, r.hit_m, cosine);
  }

  /// A draw from N(0, Sigma) in pixels of the previous frame.
  glm::vec2 sample_offset(int x, int y, const Reflection& r, float roughness) const {
    const auto spread = spread_of(r, roughness);
    const glm::vec2 along = incidence_axis(previous_pixel_, r.receiver.point, r.receiver.normal);
    const std::uint64_t pixel =
        (static_cast<std::uint64_t>(y) << 32) | static_cast<std::uint64_t>(x);
    const UniformPair random = uniform_pair(frame_key_ ^ mix_bits(pixel));
    const float radius = std::sqrt(-2.0f * std::log(random.u));  // Box-Muller
    const float angle = 2.0f * std::numbers::pi_v<float> * random.v;
    return radius * (std::cos(angle) * spread.in_plane * along +
                     std::sin(angle) * spread.out_of_plane * glm::vec2(-along.y, along.x));
  }

  bool try_pixel(int x, int y, float px, float py, const Receiver& receiver, float roughness,
                 EffectHistory& out) const {
    const Taps taps = find_taps(previous_, px, py, receiver);
    if (!taps.any() || !same_roughness(taps, roughness)) return false;
    out.set(x, y, taps, px - (static_cast<float>(x) + 0.5f), py - (static_cast<float>(y) + 0.5f),
            1.0f);
    return true;
  }

  bool same_roughness(const Taps& taps, float roughness) const {
    if (!previous_.roughness || !now_.roughness) return true;
    return std::abs(gather(previous_.roughness[0], taps) - roughness) <= kRoughnessTolerance;
  }

  static constexpr float kRoughnessTolerance = 0.1f;  // perceptual; ours

  const Guides& now_;
  const Guides& previous_;
  const SceneMotion& scene_;
  const GlossyPlanes& planes_;
  GlossyRule rule_;
  std::uint64_t frame_key_;
  glm::mat4 pixel_, previous_pixel_;
};

}  // namespace

void trace_glossy_history(const FramePair& frames, const GlossyPlanes& planes, GlossyRule rule,
                          const FrameKey& key, EffectHistory& out) {
  const GlossyTracer tracer(frames, planes, rule, key);
  for_each_row(frames.now.view.height, [&](int y) {
    for (int x = 0; x < frames.now.view.width; ++x) tracer.trace(x, y, out);
  });
}

}  // namespace holdfast
