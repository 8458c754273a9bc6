#pragma once

#include "core/frame/guides.h"
#include "core/frame/scene_motion.h"
#include "core/motion/effect_field.h"
#include "core/motion/follow_block.h"

namespace holdfast {

/// The planes of one light that say what blocks it.
struct BlockerPlanes {
  const Plane* distance = nullptr;  ///< metres from the surface, +inf = not blocked
  const Plane* sample = nullptr;    ///< (u, v) on the light
  const Plane* id = nullptr;        ///< instance of the blocker; null: blockers are static

  explicit operator bool() const { return distance != nullptr && sample != nullptr; }
};

/// One light of one frame: measures its shadows and follows them to the previous frame.
class ShadowTracer {
 public:
  /// All references must outlive the tracer. `scene` has taken the frame that `now` shows.
  ShadowTracer(const Guides& now, const SceneMotion& scene, const Light& light,
               const BlockerPlanes& planes);

  /// Measures the blocked samples of every pixel into channels first.. of `out`.
  ///   reads guides, blocker planes | writes `out` | halo 0
  void measure(Channels<float>& out, int first) const;

  /// The previous pixel of the shadow at (x, y) by its own blocked sample, whose kFieldRatio is
  /// `ratio`. `in_front` is false where it cannot be followed.
  PixelPoint<float> follow_own(int x, int y, float ratio) const;

  /// The same for a borrowed blocker: at `ratio` of the way to the light's centre, moving with the
  /// nearest blocked sample.
  PixelPoint<float> follow_borrowed(int x, int y, float ratio) const;

  /// The same for a block of pixels from (x, y) on that all lie on the object of `surface_slot` and
  /// are all shadowed by that of `occluder_slot`; pixels of which this is not so, or without
  /// surface or blocker, get unspecified results. Pixel i takes its own blocked sample where own[i]
  /// is not 0, and borrows one elsewhere and where `own` is null.
  void follow_block(const BlockPixels& pixels, int x, int y, const float* ratio,
                    const std::uint8_t* own, int surface_slot, int occluder_slot,
                    FollowedBlock& out) const;

  /// The object that blocks the sample of (x, y), and the object of the nearest blocked sample.
  int own_blocker_slot(int x, int y) const;
  int nearest_blocker_slot(int x, int y) const;
  /// Whether camera, light, receiver and blocker stand still, these as objects of their slots.
  bool at_rest(int surface_slot, int occluder_slot) const;
  /// False only if all of `count` pixels from (x, y) on have slot 0 as their nearest blocker's.
  bool moving_blockers_near(int x, int y, int count) const;

 private:
  PixelPoint<float> follow(int x, int y, float ratio, float u, float v, int occluder_slot) const;
  bool blocked(int x, int y) const;
  float sample_lights(int x, int y, int count, float (*light)[kFollowBlock]) const;

  const Guides& now_;
  const SceneMotion& scene_;
  const Light& light_;
  ChannelView<const float> distance_, u_, v_;
  ChannelView<const std::uint32_t> id_;  ///< of what blocks; null: it is static
  glm::mat4 relative_from_light_, previous_relative_from_light_;
  glm::mat3 half_axes_, previous_half_axes_;
  glm::mat4 pixel_, previous_pixel_;
  bool light_at_rest_;
};

}  // namespace holdfast
