#include "core/history/shadow_history.h"

#include <algorithm>

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
  std::uint8_t wanted[kFollowBlock];                  ///< not followed yet
  int surface[kFollowBlock], occluder[kFollowBlock];  ///< slots
};

/// Chooses what the pixels from (x, y) on follow; false if none has a shadow to follow.
bool choose(const FramePair& frames, const ShadowTracer& tracer, ShadowRule rule, int x, int y,
            int count, const float* valid, const float* ratio, const float* own_ratio,
            Lanes& lanes) {
  const float* depth = frames.now.depth().row(y) + x;
  const std::uint32_t* id = frames.now.id[0].row(y) + x;
  bool any = false;
  for (int i = 0; i < count; ++i) {
    lanes.wanted[i] = depth[i] > 0.0f && valid[i] > kLeastValid;
    any |= lanes.wanted[i] != 0;
  }
  if (!any) return false;
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

/// Writes the history of the pixels from (x, y) on whose shadows are `found`.
void take(const FramePair& frames, ShadowRule rule, const FollowedBlock& found, int x, int y,
          int count, EffectHistory& out) {
  const bool paper = rule == ShadowRule::kPaper;
  Taps taps[kFollowBlock];
  const std::uint32_t* id = frames.now.id[0].row(y) + x;
  const TapSearch search{frames.previous, found, id, count, taps};
  if (paper)
    find_block_taps_on_any_surface(search);
  else
    find_block_taps(search);
  float trust[kFollowBlock];
  if (paper)
    shadow_falloff({frames.previous, found, count, trust});
  else
    std::fill_n(trust, count, 1.0f);
  for (int i = 0; i < count; ++i)
    if (found.found[i] != 0.0f)
      out.set(x + i, y, taps[i], found.x[i] - (static_cast<float>(x + i) + 0.5f),
              found.y[i] - (static_cast<float>(y) + 0.5f), taps[i].any() ? trust[i] : 0.0f);
}

}  // namespace

void trace_shadow_history(const FramePair& frames, const ShadowTracer& tracer, ShadowRule rule,
                          ChannelView<const float> valid, ChannelView<const float> ratio,
                          ChannelView<const float> own_ratio, EffectHistory& out) {
  const Guides& now = frames.now;
  for_each_row(now.view.height, [&](int y) {
    Lanes lanes;
    FollowedBlock found{}, followed{};
    for (int x = 0; x < now.view.width; x += kFollowBlock) {
      const BlockPixels pixels(now, x, y, std::min(kFollowBlock, now.view.width - x));
      std::fill_n(out.taps[0].row(y) + x, pixels.count, Taps{});
      for (int c = 0; c < kMotionChannels; ++c)
        std::fill_n(out.motion[c].row(y) + x, pixels.count,
                    c == kMotionSweep ? kNoBlockerSweep : 0.0f);
      if (!choose(frames, tracer, rule, x, y, pixels.count, valid.row(y) + x, ratio.row(y) + x,
                  own_ratio.row(y) + x, lanes))
        continue;
      std::fill_n(followed.found, pixels.count, 0.0f);
      for (int i = 0; i < pixels.count; ++i) {
        if (!lanes.wanted[i]) continue;
        const int surface = lanes.surface[i], occluder = lanes.occluder[i];
        tracer.follow_block(pixels, x, y, lanes.ratio,
                            rule == ShadowRule::kPaper ? lanes.own : nullptr, surface, occluder,
                            found);
        for (int k = i; k < pixels.count; ++k) {
          if (!lanes.wanted[k] || lanes.surface[k] != surface || lanes.occluder[k] != occluder)
            continue;
          lanes.wanted[k] = 0;
          out.motion[kMotionSweep].at(x + k, y) = found.sweep[k];
          if (found.found[k] != 0.0f) copy_lane(found, k, followed, k);
        }
      }
      take(frames, rule, followed, x, y, pixels.count, out);
    }
  });
}

}  // namespace holdfast
