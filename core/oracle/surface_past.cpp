#include <cmath>

#include "core/oracle/frame_view.h"

namespace holdfast::oracle {
namespace {

/// Whether both frames show exactly the same surface at a pixel.
bool same_surface(const FrameView& frame, int x, int y) {
  const Surfaces &now = frame.now, &then = frame.previous;
  return now.id(x, y) == then.id(x, y) && now.depth.at(x, y) == then.depth.at(x, y) &&
         now.normal_at(x, y) == then.normal_at(x, y);
}

/// The previous position of the surface at (x, y); false where there is none.
bool follow(const FrameView& frame, const Plane* given_motion, int x, int y, glm::dvec2& at) {
  const glm::dvec2 pixel(x + 0.5, y + 0.5);
  if (given_motion != nullptr) {
    const glm::dvec2 motion(given_motion->channel(0).at(x, y), given_motion->channel(1).at(x, y));
    at = pixel + motion;
    return std::isfinite(motion.x) && std::isfinite(motion.y);
  }
  const Motion& motion = frame.scene.motion(frame.now.id(x, y));
  if (!motion.traceable) return false;
  if (motion.at_rest) {
    at = pixel;
    return true;
  }
  const PixelPoint<double> then = project(frame.scene.previous_view().pixel_from_relative,
                                          motion.point_then(frame.now.position(x, y)));
  at = {then.x, then.y};
  return then.in_front;
}

}  // namespace

Past surface_past(const FrameView& frame, const Plane* given_motion) {
  const Surfaces& now = frame.now;
  Past out(now.width, now.height);
  for_each_pixel(now.width, now.height, [&](int x, int y) {
    glm::dvec2 at;
    if (!now.any(x, y) || !follow(frame, given_motion, x, y, at)) return;
    const glm::dvec2 motion_px = at - glm::dvec2(x + 0.5, y + 0.5);
    const bool stays = motion_px == glm::dvec2(0) && same_surface(frame, x, y);
    out.at(x, y) = stays ? tap_at(x, y) : find_taps(frame.previous, at, frame.receiver(x, y));
    out.move(x, y, motion_px);
  });
  return out;
}

}  // namespace holdfast::oracle
