#include "core/history/glossy_history.h"

#include <algorithm>
#include <cmath>

#include "core/history/tap_search.h"
#include "core/kernels/parallel.h"
#include "core/kernels/random.h"
#include "core/motion/reflect_block.h"

namespace holdfast {
namespace {

constexpr float kRoughnessTolerance = 0.1f;  // perceptual; ours

/// Receivers that are looked for.
struct Wanted {
  FollowedBlock wanted;
  std::uint32_t id[kFollowBlock];
  float roughness[kFollowBlock];
  Taps taps[kFollowBlock];
};

/// A block of a row on its way to the previous frame.
struct Lanes : Wanted {
  ReflectedBlock images;
  float centre_x[kFollowBlock], centre_y[kFollowBlock];  ///< of the images
  int surface[kFollowBlock], hit[kFollowBlock];          ///< slots; -1: followed
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

  /// The pixels of a block from (x, y) on.
  void trace(int x, int y, int count, Lanes& lanes, EffectHistory& out) const {
    if (!any_sample(x, y, count)) {
      std::fill_n(lanes.wanted.found, count, 0.0f);
      return write(x, y, count, lanes, out);
    }
    find_slots(x, y, count, lanes);
    std::fill_n(lanes.wanted.found, count, 0.0f);
    for (int i = 0; i < count; ++i)
      if (lanes.surface[i] >= 0) follow(lanes.surface[i], lanes.hit[i], x, y, count, lanes);
    if (rule_ == GlossyRule::kStochastic) {
      std::copy_n(lanes.wanted.x, count, lanes.centre_x);
      std::copy_n(lanes.wanted.y, count, lanes.centre_y);
      scatter(x, y, count, lanes);
    }
    std::copy_n(now_.id[0].row(y) + x, count, lanes.id);
    find_block_taps({previous_, lanes.wanted, lanes.id, count, lanes.taps});
    drop_foreign(count, lanes);
    if (rule_ == GlossyRule::kStochastic) look_at_centres(count, lanes);
    write(x, y, count, lanes, out);
  }

 private:
  bool any_sample(int x, int y, int count) const {
    bool any = false;
    for (int axis = 0; axis < 3; ++axis) {
      const float* direction = planes_.direction->channel(axis).row(y) + x;
      for (int i = 0; i < count; ++i) any |= direction[i] != 0.0f;
    }
    return any;
  }

  void find_slots(int x, int y, int count, Lanes& lanes) const {
    const float* depth = now_.depth().row(y) + x;
    const std::uint32_t* id = now_.id[0].row(y) + x;
    const std::uint32_t* hit_id = planes_.id != nullptr ? planes_.id->ids().row(y) + x : nullptr;
    std::uint32_t last = 0, last_hit = 0;
    int slot = scene_.slot_of(last), hit_slot = hit_id != nullptr ? slot : 0;
    for (int i = 0; i < count; ++i) {
      if (id[i] != last) slot = scene_.slot_of(last = id[i]);
      if (hit_id != nullptr && hit_id[i] != last_hit)
        hit_slot = scene_.slot_of(last_hit = hit_id[i]);
      lanes.surface[i] = depth[i] > 0.0f ? slot : -1;
      lanes.hit[i] = hit_slot;
    }
    for (int i = 0; i < count; ++i) lanes.roughness[i] = now_.roughness_at(x + i, y);
  }

  /// Follows the pixels on one object that reflect another.
  void follow(int surface, int hit, int x, int y, int count, Lanes& lanes) const {
    const ObjectMotion<float>&of_surface = scene_.object(surface), &of_hit = scene_.object(hit);
    const bool traceable = of_surface.traceable && of_hit.traceable;
    // Where all stands still the image has not moved, whatever rounding says.
    const bool moves = rule_ == GlossyRule::kRelative && !(of_surface.at_rest && of_hit.at_rest);
    if (traceable) {
      const BlockPixels pixels(now_, x, y, count);
      const auto direction = [&](int axis) { return planes_.direction->channel(axis).row(y) + x; };
      follow_reflection({pixels,
                         of_surface,
                         of_hit,
                         pixel_,
                         previous_pixel_,
                         {direction(0), direction(1), direction(2)},
                         planes_.distance->channel(0).row(y) + x,
                         moves,
                         lanes.images});
    }
    for (int i = 0; i < count; ++i) {
      if (lanes.surface[i] != surface || lanes.hit[i] != hit) continue;
      lanes.surface[i] = -1;
      if (!traceable || lanes.images.then.found[i] == 0.0f) continue;
      copy_lane(lanes.images.then, i, lanes.wanted, i);
      if (rule_ != GlossyRule::kRelative) continue;
      const float moved_x = moves ? lanes.images.then.x[i] - lanes.images.x[i] : 0.0f;
      const float moved_y = moves ? lanes.images.then.y[i] - lanes.images.y[i] : 0.0f;
      lanes.wanted.x[i] = static_cast<float>(x + i) + 0.5f + moved_x;
      lanes.wanted.y[i] = static_cast<float>(y) + 0.5f + moved_y;
    }
  }

  /// Draws a place around each that is wanted.
  void scatter(int x, int y, int count, Lanes& lanes) const {
    float u[kFollowBlock], v[kFollowBlock];
    for (int i = 0; i < count; ++i) {
      const std::uint64_t pixel =
          (static_cast<std::uint64_t>(y) << 32) | static_cast<std::uint64_t>(x + i);
      const UniformPair random = uniform_pair(frame_key_ ^ mix_bits(pixel));
      u[i] = random.u;
      v[i] = random.v;
    }
    spread_reflection({previous_pixel_, 1.0f / static_cast<float>(previous_.view.pixel_angle),
                       lanes.roughness, planes_.distance->channel(0).row(y) + x, u, v, lanes.wanted,
                       count, lanes.wanted.x, lanes.wanted.y});
  }

  /// Takes the taps from receivers of another roughness.
  void drop_foreign(int count, Wanted& lanes) const {
    if (!previous_.roughness || !now_.roughness) return;
    const ChannelView<const float> roughness = previous_.roughness[0];
    for (int i = 0; i < count; ++i)
      if (!(std::abs(gather(roughness, lanes.taps[i]) - lanes.roughness[i]) <= kRoughnessTolerance))
        lanes.taps[i] = Taps{};
  }

  /// Looks at the images themselves for receivers that were not found near them, which are moved
  /// together so that no others are looked for.
  void look_at_centres(int count, Lanes& lanes) const {
    Wanted lost;
    int source[kFollowBlock], left = 0;
    for (int i = 0; i < count; ++i) {
      if (lanes.wanted.found[i] == 0.0f || lanes.taps[i].any()) continue;
      lanes.wanted.x[i] = lanes.centre_x[i];
      lanes.wanted.y[i] = lanes.centre_y[i];
      copy_lane(lanes.wanted, i, lost.wanted, left);
      lost.id[left] = lanes.id[i];
      lost.roughness[left] = lanes.roughness[i];
      source[left++] = i;
    }
    if (left == 0) return;
    find_block_taps({previous_, lost.wanted, lost.id, left, lost.taps});
    drop_foreign(left, lost);
    for (int k = 0; k < left; ++k) lanes.taps[source[k]] = lost.taps[k];
  }

  /// Writes the history of the pixels from (x, y) on: none where there are no taps.
  void write(int x, int y, int count, const Lanes& lanes, EffectHistory& out) const {
    Taps* taps = out.taps[0].row(y) + x;
    float *motion_x = out.motion[kMotionX].row(y) + x, *motion_y = out.motion[kMotionY].row(y) + x,
          *trust = out.motion[kMotionTrust].row(y) + x;
    const float row = static_cast<float>(y) + 0.5f;
    for (int i = 0; i < count; ++i) {
      const bool any = lanes.wanted.found[i] > 0.0f && lanes.taps[i].any();
      taps[i] = any ? lanes.taps[i] : Taps{};
      motion_x[i] = any ? lanes.wanted.x[i] - (static_cast<float>(x + i) + 0.5f) : 0.0f;
      motion_y[i] = any ? lanes.wanted.y[i] - row : 0.0f;
      trust[i] = any ? 1.0f : 0.0f;
    }
  }

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
  const int width = frames.now.view.width;
  for_each_row(frames.now.view.height, [&](int y) {
    Lanes lanes{};
    for (int x = 0; x < width; x += kFollowBlock)
      tracer.trace(x, y, std::min(kFollowBlock, width - x), lanes, out);
  });
}

}  // namespace holdfast
