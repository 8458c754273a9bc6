#include "core/history/glossy_history.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "core/history/motion_block.h"
#include "core/history/tap_search.h"
#include "core/kernels/parallel.h"
#include "core/kernels/random.h"
#include "core/motion/reflect_block.h"

namespace holdfast {
namespace {

/// A block of a row on its way to the previous frame.
struct Lanes {
  FollowedBlock wanted;                                  ///< the receivers that are looked for
  FollowedBlock some;                                    ///< of those on one of several objects
  float any[kFollowBlock];                               ///< 1: there are taps
  float now_x[kFollowBlock], now_y[kFollowBlock];        ///< of the images, this frame
  float centre_x[kFollowBlock], centre_y[kFollowBlock];  ///< of the images, one frame ago
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
    Taps* taps = out.taps[0].row(y) + x;
    std::fill_n(lanes.wanted.found, count, 0.0f);
    if (any_sample(x, y, count)) {
      const bool one_pair = find_slots(x, y, count, lanes);
      for (int i = 0; i < count; ++i)
        if (lanes.surface[i] >= 0)
          follow(lanes.surface[i], lanes.hit[i], one_pair, x, y, count, lanes);
    }
    if (!any_bit(lanes.wanted.found, count)) {
      clear(taps, count);
      std::fill_n(lanes.any, count, 0.0f);
      return write(x, y, count, lanes, out);
    }
    if (rule_ == GlossyRule::kStochastic) {
      std::copy_n(lanes.wanted.x, count, lanes.centre_x);
      std::copy_n(lanes.wanted.y, count, lanes.centre_y);
      scatter(x, y, count, lanes);
    }
    const std::uint32_t* id = now_.id[0].row(y) + x;
    find_block_taps({previous_, lanes.wanted, id, count, taps, known_roughness(x, y), lanes.any});
    if (rule_ == GlossyRule::kStochastic) look_at_centres(x, y, count, lanes, taps);
    write(x, y, count, lanes, out);
  }

 private:
  bool any_sample(int x, int y, int count) const {
    for (int axis = 0; axis < 3; ++axis) {
      if (any_bit(planes_.direction->channel(axis).row(y) + x, count)) return true;
    }
    return false;
  }

  /// True if any value is not 0.
  static bool any_bit(const float* values, int count) {
    std::uint32_t bits = 0;
    for (int i = 0; i < count; ++i) bits |= std::bit_cast<std::uint32_t>(values[i]);
    return bits << 1 != 0;  // but for the sign of 0
  }

  /// True if all surfaces are of one object and reflect one object.
  bool find_slots(int x, int y, int count, Lanes& lanes) const {
    const float* depth = now_.depth().row(y) + x;
    const std::uint32_t* id = now_.id[0].row(y) + x;
    const std::uint32_t* hit_id = planes_.id != nullptr ? planes_.id->ids().row(y) + x : nullptr;
    bool one_pair = SlotFinder(scene_).of_all(id, count, lanes.surface);
    if (hit_id != nullptr)
      one_pair &= SlotFinder(scene_).of_all(hit_id, count, lanes.hit);
    else
      std::fill_n(lanes.hit, count, 0);
    for (int i = 0; i < count; ++i) lanes.surface[i] = depth[i] > 0.0f ? lanes.surface[i] : -1;
    if (one_pair) return true;
    const int* first =
        std::find_if(lanes.surface, lanes.surface + count, [](int s) { return s >= 0; });
    const auto at = first - lanes.surface;
    one_pair = true;
    for (auto i = at; i < count; ++i)
      one_pair &= lanes.surface[i] < 0 ||
                  (lanes.surface[i] == lanes.surface[at] && lanes.hit[i] == lanes.hit[at]);
    return one_pair;
  }

  /// Follows the pixels on one object that reflect another; `all`: there are no others.
  void follow(int surface, int hit, bool all, int x, int y, int count, Lanes& lanes) const {
    const ObjectMotion<float>&of_surface = scene_.object(surface), &of_hit = scene_.object(hit);
    // Where all stands still the image has not moved: its vector is its surface's.
    const bool relative = rule_ == GlossyRule::kRelative;
    const bool stays = relative && of_surface.at_rest && of_hit.at_rest;
    const bool followed = of_surface.traceable && of_hit.traceable && !stays;
    FollowedBlock& then = all ? lanes.wanted : lanes.some;
    if (followed) {
      const BlockPixels pixels(now_, x, y, count);
      const auto direction = [&](int axis) { return planes_.direction->channel(axis).row(y) + x; };
      follow_reflection({pixels,
                         of_surface,
                         of_hit,
                         pixel_,
                         previous_pixel_,
                         {direction(0), direction(1), direction(2)},
                         planes_.distance->channel(0).row(y) + x,
                         then,
                         relative ? lanes.now_x : nullptr,
                         relative ? lanes.now_y : nullptr});
      if (relative) displace(x, y, count, lanes, then);
    }
    for (int i = 0; i < count; ++i) {
      if (lanes.surface[i] != surface || lanes.hit[i] != hit) continue;
      lanes.surface[i] = -1;
      if (!all && followed && then.found[i] > 0.0f) copy_lane(then, i, lanes.wanted, i);
    }
  }

  /// From where images were to where pixels were that move as they do.
  static void displace(int x, int y, int count, const Lanes& lanes, FollowedBlock& then) {
    const float first_x = static_cast<float>(x) + 0.5f, row = static_cast<float>(y) + 0.5f;
    for (int i = 0; i < count; ++i) {
      then.x[i] = static_cast<float>(i) + first_x + (then.x[i] - lanes.now_x[i]);
      then.y[i] = row + (then.y[i] - lanes.now_y[i]);
    }
  }

  /// Draws a place around each that is wanted.
  void scatter(int x, int y, int count, Lanes& lanes) const {
    static constexpr float kMirrors[kFollowBlock] = {};
    const float* roughness = now_.roughness ? now_.roughness[0].row(y) + x : kMirrors;
    float u[kFollowBlock], v[kFollowBlock];
    draw_pairs({frame_key_, (static_cast<std::uint64_t>(y) << 32) | static_cast<std::uint64_t>(x),
                count, u, v});
    spread_reflection({previous_pixel_, 1.0f / static_cast<float>(previous_.view.pixel_angle),
                       roughness, planes_.distance->channel(0).row(y) + x, u, v, lanes.wanted,
                       count, lanes.wanted.x, lanes.wanted.y});
  }

  /// Of the receivers from (x, y) on; null where not both frames have it.
  const float* known_roughness(int x, int y) const {
    return now_.roughness && previous_.roughness ? now_.roughness[0].row(y) + x : nullptr;
  }

  /// Looks at the images themselves for receivers that were not found near them, which are moved
  /// together so that no others are looked for.
  void look_at_centres(int x, int y, int count, Lanes& lanes, Taps* taps) const {
    const std::uint32_t* id = now_.id[0].row(y) + x;
    const float* roughness = known_roughness(x, y);
    FollowedBlock lost;
    std::uint32_t lost_id[kFollowBlock];
    float lost_roughness[kFollowBlock], any[kFollowBlock];
    Taps found[kFollowBlock];
    int source[kFollowBlock], left = 0;
    for (int i = 0; i < count; ++i) {
      if (lanes.wanted.found[i] == 0.0f || lanes.any[i] > 0.0f) continue;
      lanes.wanted.x[i] = lanes.centre_x[i];
      lanes.wanted.y[i] = lanes.centre_y[i];
      copy_lane(lanes.wanted, i, lost, left);
      lost_id[left] = id[i];
      lost_roughness[left] = roughness != nullptr ? roughness[i] : 0.0f;
      source[left++] = i;
    }
    if (left == 0) return;
    find_block_taps({previous_, lost, lost_id, left, found,
                     roughness != nullptr ? lost_roughness : nullptr, any});
    for (int k = 0; k < left; ++k) {
      taps[source[k]] = found[k];
      lanes.any[source[k]] = any[k];
    }
  }

  /// Writes the vectors of the pixels from (x, y) on: none where there are no taps.
  void write(int x, int y, int count, const Lanes& lanes, EffectHistory& out) const {
    write_motion({lanes.wanted.x, lanes.wanted.y, lanes.any, count, static_cast<float>(x) + 0.5f,
                  static_cast<float>(y) + 0.5f, out.motion[kMotionX].row(y) + x,
                  out.motion[kMotionY].row(y) + x, nullptr});
    std::copy_n(lanes.any, count, out.motion[kMotionTrust].row(y) + x);
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
