#include "core/history/shadow_history.h"

#include <algorithm>
#include <cmath>

#include "core/history/tap_search.h"
#include "core/kernels/parallel.h"
#include "core/motion/shadow_motion.h"

namespace holdfast {
namespace {

constexpr float kNoBlockerSweep = 1e6f;  // where nothing blocks, a visibility is what is seen now
constexpr float kLeastValid =
    1e-3f;  // share of blocked samples nearby below which none is borrowed

/// TRMV's trust in the vector that leads to previous pixel (px, py): compares the receiver's plane
/// with the surface seen there. 0 where there is none.
float falloff_at(const Guides& previous, const Receiver& receiver, float px, float py) {
  const int x = static_cast<int>(std::floor(px)), y = static_cast<int>(std::floor(py));
  if (x < 0 || y < 0 || x >= previous.view.width || y >= previous.view.height ||
      !(previous.depth().at(x, y) > 0.0f))
    return 0.0f;
  // The receiver's plane along the ray of (px, py): X(d) is affine in d.
  const glm::vec3 start = previous.rays.position(px, py, 0.0f);
  const glm::vec3 ray = previous.rays.position(px, py, 1.0f) - start;
  const float facing = glm::dot(ray, receiver.normal);
  if (!(std::abs(facing) > 1e-6f)) return 0.0f;
  const float depth = glm::dot(receiver.point - start, receiver.normal) / facing;
  const float footprint = static_cast<float>(previous.view.pixel_angle) *
                          (previous.rays.near_weight + previous.rays.far_weight * depth);
  return planarity_falloff(start + depth * ray, previous.position_at(x, y), receiver.normal,
                           footprint);
}

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
  for (int i = 0; i < count; ++i) {
    const bool own = rule == ShadowRule::kPaper && own_ratio[i] > 0.0f;
    lanes.own[i] = own;
    lanes.ratio[i] = own ? own_ratio[i] : ratio[i] / (lanes.wanted[i] ? valid[i] : 1.0f);
    if (!lanes.wanted[i]) continue;
    lanes.surface[i] = frames.scene.slot_of(id[i]);
    lanes.occluder[i] =
        own ? tracer.own_blocker_slot(x + i, y) : tracer.nearest_blocker_slot(x + i, y);
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
  for (int i = 0; i < count; ++i) {
    if (found.found[i] == 0.0f) continue;
    float trust = 0;
    if (taps[i].any())
      trust =
          paper ? falloff_at(frames.previous, receiver_of(found, i, id[i]), found.x[i], found.y[i])
                : 1.0f;
    out.set(x + i, y, taps[i], found.x[i] - (static_cast<float>(x + i) + 0.5f),
            found.y[i] - (static_cast<float>(y) + 0.5f), trust);
  }
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
          if (found.found[k] != 0.0f) copy_lane(found, k, followed);
        }
      }
      take(frames, rule, followed, x, y, pixels.count, out);
    }
  });
}

}  // namespace holdfast
