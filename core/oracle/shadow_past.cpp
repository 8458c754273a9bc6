#include <cmath>

#include "core/motion/effect_field.h"
#include "core/motion/follow_block.h"
#include "core/motion/shadow_motion.h"
#include "core/oracle/shadows.h"

namespace holdfast::oracle {
namespace {

constexpr double kAppeared = double{kAppearedSweep};
constexpr double kNoBlocker = 1e6;    // sweep where nobody knows a blocker, or where it was
constexpr double kLeastValid = 1e-3;  // share of blocked samples nearby that one is borrowed from
constexpr int kSearchRadius = 3;      // px

/// The object of the nearest blocked sample, the first of equals row by row; 0 if there is none.
std::uint32_t nearest_blocker(const Surfaces& now, const ShadowInput& input, int x, int y) {
  std::uint32_t id = 0;
  int best = 2 * kSearchRadius * kSearchRadius + 1;
  for (int dy = -kSearchRadius; dy <= kSearchRadius; ++dy)
    for (int dx = -kSearchRadius; dx <= kSearchRadius; ++dx) {
      const int distance2 = dx * dx + dy * dy, qx = x + dx, qy = y + dy;
      if (distance2 >= best || !now.inside(qx, qy) || !input.blocked(now, qx, qy)) continue;
      best = distance2;
      id = input.blocker_id(qx, qy);
    }
  return id;
}

/// TRMV's trust: the surface that was seen at `at` against the receiver's plane there.
double trust_of(const Surfaces& previous, const Receiver& receiver, const glm::dvec2& at) {
  const int x = static_cast<int>(std::floor(at.x)), y = static_cast<int>(std::floor(at.y));
  if (!previous.inside(x, y) || !previous.any(x, y)) return 0;
  // Along the pixel's ray, positions are affine in depth.
  const PixelRays<double>& rays = previous.view.rays;
  const glm::dvec3 start = rays.position(at.x, at.y, 0.0);
  const glm::dvec3 ray = rays.position(at.x, at.y, 1.0) - start;
  const double facing = glm::dot(ray, receiver.normal);
  if (!(std::abs(facing) > 1e-6)) return 0;
  const double depth = glm::dot(receiver.point - start, receiver.normal) / facing;
  return planarity_falloff(start + depth * ray, previous.position(x, y), receiver.normal,
                           previous.pixel_width(depth));
}

/// What one pixel's shadow is followed by.
struct Followed {
  bool own = false;
  double ratio = 0;
  std::uint32_t blocker = 0;
};

/// Follows the shadow at (x, y) and writes where it was.
void follow(const FrameView& frame, const ShadowInput& input, bool paper, const Followed& what,
            int x, int y, Past& out) {
  const Surfaces& now = frame.now;
  const Motion& surface = frame.scene.motion(now.id(x, y));
  const Motion& occluder = frame.scene.motion(what.blocker);
  if (!surface.traceable || !occluder.traceable) return;
  const bool still = surface.at_rest && occluder.at_rest && !occluder.appeared &&
                     frame.scene.light(input.light.id).at_rest;
  if (!paper && still) {  // as the surface
    out.sweep.at(x, y) = 0;
    return;
  }
  const glm::dvec4 local = what.own ? input.own_sample(x, y) : light_point(input.light, 0.5, 0.5);
  const glm::dvec4 light = input.places.now * local;
  const glm::dvec3 point = now.position(x, y);
  const glm::dvec3 blocker = point + what.ratio * (glm::dvec3(light) - light.w * point);
  const Receiver receiver = frame.receiver(x, y);
  const ShadowSample<double> sample{receiver.point, receiver.normal, occluder.point_then(blocker),
                                    input.places.then * local};
  const glm::dmat3 half_axes = glm::dmat3(input.places.then) * light_half_axes(input.light);
  out.sweep.at(x, y) = occluder.appeared ? kAppeared : shadow_sweep(sample, what.ratio, half_axes);
  glm::dvec3 hit;
  if (!shadow_previous_point(sample, hit)) return;
  const auto then = project(frame.scene.previous_view().pixel_from_relative, hit);
  if (!then.in_front) return;
  const glm::dvec2 at(then.x, then.y);
  out.move(x, y, at - glm::dvec2(x + 0.5, y + 0.5));
  out.at(x, y) = paper ? find_taps_on_any_surface(frame.previous, at)
                       : find_taps(frame.previous, at, receiver);
  if (!out.at(x, y).any()) return;
  out.trust.at(x, y) = paper ? trust_of(frame.previous, receiver, at) : 1;
}

}  // namespace

Past shadow_past(const FrameView& frame, const ShadowInput& input, bool paper, const Image& field,
                 const Statistics& statistics) {
  const Surfaces& now = frame.now;
  Past out(now.width, now.height);
  for_each_pixel(now.width, now.height, [&](int x, int y) {
    out.sweep.at(x, y) = kNoBlocker;
    const double valid = statistics.valid.at(x, y), own_ratio = field.at(x, y, kFieldRatio);
    if (!now.any(x, y) || !(valid > kLeastValid)) return;
    Followed what;
    what.own = paper && own_ratio > 0;
    what.ratio = what.own ? own_ratio : statistics.ratio.at(x, y) / valid;
    what.blocker = what.own || input.blocked(now, x, y) ? input.blocker_id(x, y)
                                                        : nearest_blocker(now, input, x, y);
    follow(frame, input, paper, what, x, y, out);
  });
  return out;
}

}  // namespace holdfast::oracle
