#include "core/oracle/dual_past.h"

#include <cmath>

#include "core/motion/dual_motion.h"

namespace holdfast::oracle {
namespace {

/// Where the surface that was seen at `then`, in pixel (x, y) of the previous frame, is now; false
/// where it cannot be followed.
bool follow_onwards(const FrameView& frame, const glm::dvec2& then, int x, int y, glm::dvec2& now) {
  const Surfaces& previous = frame.previous;
  if (previous.motion) {
    const glm::dvec2 motion(previous.motion.at(x, y, 0), previous.motion.at(x, y, 1));
    now = then - motion;
    return std::isfinite(motion.x) && std::isfinite(motion.y);
  }
  const Motion& motion = frame.scene.motion(previous.id(x, y));
  if (!motion.traceable) return false;
  const glm::dvec3 point = previous.view.rays.position(then.x, then.y, previous.depth.at(x, y));
  const auto at = project(frame.now.view.pixel_from_relative, motion.point_now(point));
  now = {at.x, at.y};
  return at.in_front;
}

}  // namespace

Past dual_past(const FrameView& frame) {
  const Surfaces &now = frame.now, &previous = frame.previous;
  Past out(now.width, now.height);
  for_each_pixel(now.width, now.height, [&](int x, int y) {
    if (!now.any(x, y) || frame.surface->at(x, y).any()) return;
    const glm::dvec2 pixel(x + 0.5, y + 0.5);
    const Image& motion = frame.surface->motion;
    const glm::dvec2 hidden_at = pixel + glm::dvec2(motion.at(x, y, 0), motion.at(x, y, 1));
    if (!(hidden_at.x >= 0 && hidden_at.y >= 0 && hidden_at.x < previous.width &&
          hidden_at.y < previous.height))
      return;
    const int hx = static_cast<int>(hidden_at.x), hy = static_cast<int>(hidden_at.y);
    if (!previous.any(hx, hy)) return;
    glm::dvec2 occluder_now;
    if (!follow_onwards(frame, hidden_at, hx, hy, occluder_now)) return;
    const glm::dvec2 at = dual_previous_pixel(pixel, hidden_at, occluder_now);
    const Taps taps = find_similar_taps(previous, at, frame.receiver(x, y), previous.id(hx, hy));
    if (!taps.any()) return;
    out.at(x, y) = taps;
    out.move(x, y, at - pixel);
    out.trust.at(x, y) = 1;
  });
  return out;
}

}  // namespace holdfast::oracle
