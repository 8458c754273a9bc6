#include "core/history/shadow_history.h"

#include <algorithm>

#include "core/history/motion_block.h"
#include "core/history/tap_search.h"
#include "core/kernels/parallel.h"
#include "core/motion/shadow_falloff.h"
#include "core/motion/shadow_field.h"

namespace holdfast {
namespace {

constexpr float kNoBlockerSweep = 1e6f;  // where nothing blocks, a visibility is what is seen now
constexpr float kLeastValid =
    1e-3f;  // share of blocked samples nearby below which none is borrowed

/// A block of a row on its way to the previous frame.
struct Lanes {
  float ratio[kFollowBlock];
  std::uint8_t own[kFollowBlock];                     ///< follows its own blocked sample
  int wanted[kFollowBlock];                           ///< not followed yet
  int surface[kFollowBlock], occluder[kFollowBlock];  ///< slots
  FollowedBlock some, followed;
};

/// Chooses what the pixels from (x, y) on follow; false if none has a shadow to follow.
bool choose(const FramePair& frames, const ShadowTracer& tracer, ShadowRule rule, int x, int y,
            int count, const float* valid, const float* ratio, const float* own_ratio,
            Lanes& lanes) {
  const float* depth = frames.now.depth().row(y) + x;
  const std::uint32_t* id = frames.now.id[0].row(y) + x;
  int any = 0;
  for (int i = 0; i < count; ++i) {
    lanes.wanted[i] = (depth[i] > 0.0f) & (valid[i] > kLeastValid) ? 1 : 0;
    any |= lanes.wanted[i];
  }
  if (any == 0) return false;
  const bool moving = tracer.moving_blockers_near(x, y, count);
  SlotFinder slot(frames.scene);
  for (int i = 0; i < count; ++i) {
    const bool own = rule == ShadowRule::kPaper && own_ratio[i] > 0.0f;
    lanes.own[i] = own;
    lanes.ratio[i] = own ? own_ratio[i] : ratio[i] / (lanes.wanted[i] ? valid[i] : 1.0f);
    if (!lanes.wanted[i]) continue;
    lanes.surface[i] = slot.of(id[i]);
    lanes.occluder[i] = !moving ? 0
                        : own   ? tracer.own_blocker_slot(x + i, y)
                                : tracer.nearest_blocker_slot(x + i, y);
  }
  return true;
}

/// Whether all that are wanted lie on one object in the shadow of one object: those of `first`.
bool is_one_pair(const Lanes& lanes, int first, int count) {
  for (int i = first + 1; i < count; ++i)
    if (lanes.wanted[i] &&
        (lanes.surface[i] != lanes.surface[first] || lanes.occluder[i] != lanes.occluder[first]))
      return false;
  return true;
}

/// Follows the pixels on one object in the shadow of another. Where nothing of that has moved, a
/// borrowed vector would be the surface's: there is none beside it.
void follow_pair(const ShadowTracer& tracer, ShadowRule rule, const BlockPixels& pixels, int x,
                 int y, const Lanes& lanes, int surface, int occluder, FollowedBlock& out) {
  if (rule == ShadowRule::kBorrowed && tracer.at_rest(surface, occluder)) {
    std::fill_n(out.found, pixels.count, 0.0f);
    std::fill_n(out.sweep, pixels.count, 0.0f);
    return;
  }
  const std::uint8_t* own = rule == ShadowRule::kPaper ? lanes.own : nullptr;
  tracer.follow_block(pixels, x, y, lanes.ratio, own, surface, occluder, out);
}

/// Follows all that are wanted.
void follow(const ShadowTracer& tracer, ShadowRule rule, const BlockPixels& pixels, int x, int y,
            Lanes& lanes) {
  FollowedBlock& followed = lanes.followed;
  const int first = static_cast<int>(std::find_if(lanes.wanted, lanes.wanted + pixels.count,
                                                  [](int wanted) { return wanted != 0; }) -
                                     lanes.wanted);
  if (is_one_pair(lanes, first, pixels.count)) {
    follow_pair(tracer, rule, pixels, x, y, lanes, lanes.surface[first], lanes.occluder[first],
                followed);
    for (int i = 0; i < pixels.count; ++i) {
      followed.found[i] = lanes.wanted[i] ? followed.found[i] : 0.0f;
      followed.sweep[i] = lanes.wanted[i] ? followed.sweep[i] : kNoBlockerSweep;
    }
    return;
  }
  std::fill_n(followed.found, pixels.count, 0.0f);
  std::fill_n(followed.sweep, pixels.count, kNoBlockerSweep);
  for (int i = first; i < pixels.count; ++i) {
    if (!lanes.wanted[i]) continue;
    const int surface = lanes.surface[i], occluder = lanes.occluder[i];
    follow_pair(tracer, rule, pixels, x, y, lanes, surface, occluder, lanes.some);
    for (int k = i; k < pixels.count; ++k) {
      if (!lanes.wanted[k] || lanes.surface[k] != surface || lanes.occluder[k] != occluder)
        continue;
      lanes.wanted[k] = 0;
      followed.sweep[k] = lanes.some.sweep[k];
      if (lanes.some.found[k] != 0.0f) copy_lane(lanes.some, k, followed, k);
    }
  }
}

/// Writes the history of the pixels from (x, y) on that have been followed.
void take(const FramePair& frames, ShadowRule rule, const FollowedBlock& found, int x, int y,
          int count, EffectHistory& out) {
  float any[kFollowBlock], trust[kFollowBlock];
  const TapSearch search{
      frames.previous, found, frames.now.id[0].row(y) + x, count, out.taps[0].row(y) + x,
      nullptr,         any};
  if (rule == ShadowRule::kPaper) {
    find_block_taps_on_any_surface(search);
    shadow_falloff({frames.previous, found, count, trust});
  } else {
    find_block_taps(search);
    std::fill_n(trust, count, 1.0f);
  }
  write_motion({found.x, found.y, found.found, count, static_cast<float>(x) + 0.5f,
                static_cast<float>(y) + 0.5f, out.motion[kMotionX].row(y) + x,
                out.motion[kMotionY].row(y) + x, nullptr});
  float* motion_trust = out.motion[kMotionTrust].row(y) + x;
  for (int i = 0; i < count; ++i) motion_trust[i] = any[i] > 0.0f ? trust[i] : 0.0f;
  std::copy_n(found.sweep, count, out.motion[kMotionSweep].row(y) + x);
}

/// No shadow to follow.
void take_none(int x, int y, int count, EffectHistory& out) {
  clear(out.taps[0].row(y) + x, count);
  for (int c = 0; c < kMotionChannels; ++c)
    std::fill_n(out.motion[c].row(y) + x, count, c == kMotionSweep ? kNoBlockerSweep : 0.0f);
}

}  // namespace

void trace_shadow_history(const FramePair& frames, const ShadowTracer& tracer, ShadowRule rule,
                          ChannelView<const float> valid, ChannelView<const float> ratio,
                          ChannelView<const float> own_ratio, EffectHistory& out) {
  const Guides& now = frames.now;
  for_each_row(now.view.height, [&](int y) {
    Lanes lanes{};
    for (int x = 0; x < now.view.width; x += kFollowBlock) {
      const BlockPixels pixels(now, x, y, std::min(kFollowBlock, now.view.width - x));
      if (!choose(frames, tracer, rule, x, y, pixels.count, valid.row(y) + x, ratio.row(y) + x,
                  own_ratio.row(y) + x, lanes)) {
        take_none(x, y, pixels.count, out);
        continue;
      }
      follow(tracer, rule, pixels, x, y, lanes);
      take(frames, rule, lanes.followed, x, y, pixels.count, out);
    }
  });
}

}  // namespace holdfast
