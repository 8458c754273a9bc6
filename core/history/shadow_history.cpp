#include "core/history/shadow_history.h"

#include <cmath>

#include "core/history/surface_history.h"
#include "core/kernels/parallel.h"
#include "core/motion/shadow_motion.h"

namespace holdfast {
namespace {

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

}  // namespace

void trace_shadow_history(const FramePair& frames, const ShadowTracer& tracer, ShadowRule rule,
                          ChannelView<const float> valid, ChannelView<const float> ratio,
                          ChannelView<const float> own_ratio, EffectHistory& out) {
  const Guides& now = frames.now;
  for_each_row(now.view.height, [&](int y) {
    for (int x = 0; x < now.view.width; ++x) {
      Taps taps;
      float motion_x = 0, motion_y = 0, trust = 0;
      const float borrowed = valid.at(x, y), own = own_ratio.at(x, y);
      if (now.depth().at(x, y) > 0.0f && borrowed > kLeastValid) {
        const bool use_own = rule == ShadowRule::kPaper && own > 0.0f;
        const auto pixel = use_own ? tracer.follow_own(x, y, own)
                                   : tracer.follow_borrowed(x, y, ratio.at(x, y) / borrowed);
        if (pixel.in_front) {
          const int slot = frames.scene.slot_of(now.id[0].at(x, y));
          const Receiver receiver = previous_receiver(now, frames.scene.object(slot), x, y);
          taps = rule == ShadowRule::kPaper
                     ? find_taps_on_any_surface(frames.previous, pixel.x, pixel.y)
                     : find_taps(frames.previous, pixel.x, pixel.y, receiver);
          motion_x = pixel.x - (static_cast<float>(x) + 0.5f);
          motion_y = pixel.y - (static_cast<float>(y) + 0.5f);
          trust = !taps.any() ? 0.0f
                  : rule == ShadowRule::kPaper
                      ? falloff_at(frames.previous, receiver, pixel.x, pixel.y)
                      : 1.0f;
        }
      }
      out.set(x, y, taps, motion_x, motion_y, trust);
    }
  });
}

}  // namespace holdfast
