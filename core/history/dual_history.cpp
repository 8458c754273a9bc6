#include "core/history/dual_history.h"

#include <cmath>

#include "core/kernels/parallel.h"
#include "core/motion/dual_motion.h"

namespace holdfast {
namespace {

/// Where the surface seen at previous position y is now; not in front where it cannot be followed.
PixelPoint<float> onward_pixel(const FramePair& frames, const glm::vec2& y, int ix, int iy) {
  const Guides& previous = frames.previous;
  if (previous.motion) {
    const float mx = previous.motion[0].at(ix, iy), my = previous.motion[1].at(ix, iy);
    return {y.x - mx, y.y - my, 0.0f, std::isfinite(mx) && std::isfinite(my)};
  }
  const ObjectMotion<float>& object =
      frames.scene.object(frames.scene.slot_of(previous.id[0].at(ix, iy)));
  if (!object.traceable) return {0, 0, 0, false};
  return project(object.next_pixel, previous.rays.position(y.x, y.y, previous.depth().at(ix, iy)));
}

Taps dual_taps(const FramePair& frames, const SurfaceHistory& surface, int x, int y,
               glm::vec2& motion_px) {
  const Guides& previous = frames.previous;
  const glm::vec2 pixel(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
  const glm::vec2 hidden_at =
      pixel + glm::vec2(surface.motion[0].at(x, y), surface.motion[1].at(x, y));
  const auto ix = static_cast<int>(std::floor(hidden_at.x));
  const auto iy = static_cast<int>(std::floor(hidden_at.y));
  if (ix < 0 || iy < 0 || ix >= previous.view.width || iy >= previous.view.height ||
      !(previous.depth().at(ix, iy) > 0.0f))
    return {};
  const auto occluder_now = onward_pixel(frames, hidden_at, ix, iy);
  if (!occluder_now.in_front) return {};
  const glm::vec2 from =
      dual_previous_pixel(pixel, hidden_at, glm::vec2(occluder_now.x, occluder_now.y));
  motion_px = from - pixel;
  const Guides& now = frames.now;
  const int slot = frames.scene.slot_of(now.id[0].at(x, y));
  return find_similar_taps(previous, from.x, from.y,
                           previous_receiver(now, frames.scene.object(slot), x, y),
                           previous.id[0].at(ix, iy));
}

}  // namespace

void trace_dual_history(const FramePair& frames, const SurfaceHistory& surface,
                        EffectHistory& out) {
  const int width = frames.now.view.width;
  for_each_row(frames.now.view.height, [&](int y) {
    const float* depth = frames.now.depth().row(y);
    const Taps* followed = surface.taps[0].row(y);
    constexpr int kBlock = SurfaceHistory::kBlock;
    for (int x = 0; x < width; ++x) {
      if (x % kBlock == 0 && surface.all_have_taps(x, y, 1)) {
        x += kBlock - 1;
        continue;
      }
      if (followed[x].any()) continue;
      glm::vec2 motion_px(0.0f);
      Taps taps;
      if (depth[x] > 0.0f) taps = dual_taps(frames, surface, x, y, motion_px);
      const float any = taps.any() ? 1.0f : 0.0f;
      out.set(x, y, taps, any * motion_px.x, any * motion_px.y, any);
    }
  });
}

}  // namespace holdfast
