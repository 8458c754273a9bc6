#include "core/history/surface_history.h"

#include <cmath>

#include "core/kernels/parallel.h"
#include "core/motion/surface_motion.h"

namespace holdfast {
namespace {

/// The previous position of the surface at (x, y); not in front where nothing corresponds.
PixelPoint<float> previous_pixel(const Guides& now, const ObjectMotion<float>& object,
                                 const Plane* given_motion, int x, int y) {
  const float px = static_cast<float>(x) + 0.5f, py = static_cast<float>(y) + 0.5f;
  if (given_motion != nullptr) {
    const float mx = given_motion->channel(0).at(x, y), my = given_motion->channel(1).at(x, y);
    return {px + mx, py + my, 0.0f, std::isfinite(mx) && std::isfinite(my)};
  }
  if (!object.traceable) return {0, 0, 0, false};
  if (object.at_rest) return {px, py, 0.0f, true};
  return surface_previous_pixel(object, now.position_at(x, y));
}

}  // namespace

void trace_surface_history(const FramePair& frames, const Plane* given_motion,
                           SurfaceHistory& out) {
  const Guides& now = frames.now;
  for_each_row(now.view.height, [&](int y) {
    std::uint32_t last_id = 0;
    int slot = frames.scene.slot_of(last_id);
    for (int x = 0; x < now.view.width; ++x) {
      Taps taps;
      float motion_x = 0, motion_y = 0;
      if (now.depth().at(x, y) > 0.0f) {
        if (const std::uint32_t id = now.id[0].at(x, y); id != last_id) {
          last_id = id;
          slot = frames.scene.slot_of(id);
        }
        const ObjectMotion<float>& object = frames.scene.object(slot);
        const auto pixel = previous_pixel(now, object, given_motion, x, y);
        if (pixel.in_front) {
          motion_x = pixel.x - (static_cast<float>(x) + 0.5f);
          motion_y = pixel.y - (static_cast<float>(y) + 0.5f);
          taps = motion_x == 0.0f && motion_y == 0.0f && same_surface(now, frames.previous, x, y)
                     ? identity_taps(frames.previous, x, y)
                     : find_taps(frames.previous, pixel.x, pixel.y,
                                 previous_receiver(now, object, x, y));
        }
      }
      out.taps[0].at(x, y) = taps;
      out.motion[0].at(x, y) = motion_x;
      out.motion[1].at(x, y) = motion_y;
    }
  });
}

}  // namespace holdfast
