#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/frame/conventions.h"
#include "core/kernels/random.h"
#include "core/motion/glossy_motion.h"
#include "core/oracle/reflections.h"

namespace holdfast::oracle {
namespace {

constexpr double kRoughnessTolerance = double{0.1f};  // perceptual

/// The sampled hit of a pixel: a point (w = 1) relative to the camera, or a direction.
struct Hit {
  glm::dvec4 now{0};
  double distance = 0;
  bool sampled = false;
};

Hit hit_of(const Surfaces& now, const ReflectionInput& input, int x, int y) {
  const glm::dvec3 along(input.direction.channel(0).at(x, y), input.direction.channel(1).at(x, y),
                         input.direction.channel(2).at(x, y));
  const double length = glm::length(along);
  Hit hit;
  hit.distance = double{input.distance.channel(0).at(x, y)};
  hit.sampled = length > 0 && std::isfinite(length) && hit.distance >= 0;
  if (!hit.sampled) return hit;
  const glm::dvec3 unit = along / length;
  hit.now = std::isfinite(hit.distance) ? glm::dvec4(now.position(x, y) + hit.distance * unit, 1)
                                        : glm::dvec4(unit, 0);
  return hit;
}

/// A draw from N(centre, Sigma): the region that can reflect to the same hit (TRMV).
glm::dvec2 scattered(const FrameView& frame, const Receiver& receiver, const Hit& hit,
                     const FrameKey& key, int x, int y, const glm::dvec2& centre) {
  const std::uint64_t frame_key =
      mix_bits(key.seed ^ mix_bits(static_cast<std::uint64_t>(key.frame)));
  const std::uint64_t pixel = (static_cast<std::uint64_t>(y) << 32) | static_cast<std::uint64_t>(x);
  const UniformPair random = uniform_pair(frame_key ^ mix_bits(pixel));
  const ViewGeometry& view = frame.previous.view;
  const double view_m = glm::length(receiver.point);
  const double cosine =
      std::abs(glm::dot(receiver.point, receiver.normal)) / std::max(view_m, 1e-20);
  const auto spread =
      glossy_spread(1 / view.pixel_angle, ggx_alpha_from_roughness(frame.now.roughness_at(x, y)),
                    view_m, hit.distance, cosine);
  const glm::dvec2 along =
      incidence_axis(view.pixel_from_relative, receiver.point, receiver.normal);
  const glm::dvec2 across(-along.y, along.x);
  // Box and Muller's normal numbers.
  const double radius = std::sqrt(-2 * std::log(double{random.u}));
  const double turn = 2 * std::numbers::pi * double{random.v};
  return centre + radius * std::cos(turn) * spread.in_plane * along +
         radius * std::sin(turn) * spread.out_of_plane * across;
}

/// Taps that show the same receiver, roughness included.
Taps taps_of(const FrameView& frame, const Receiver& receiver, int x, int y, const glm::dvec2& at) {
  const Taps taps = find_taps(frame.previous, at, receiver);
  if (!taps.any() || !frame.now.roughness || !frame.previous.roughness) return taps;
  const double then = taps.read(frame.previous.roughness);
  return std::abs(then - frame.now.roughness.at(x, y)) <= kRoughnessTolerance ? taps : Taps{};
}

}  // namespace

Past reflection_past(const FrameView& frame, const ReflectionInput& input, GlossyRule rule,
                     const FrameKey& key) {
  const Surfaces& now = frame.now;
  Past out(now.width, now.height);
  for_each_pixel(now.width, now.height, [&](int x, int y) {
    if (!now.any(x, y)) return;
    const Motion& surface = frame.scene.motion(now.id(x, y));
    const Motion& mirrored = frame.scene.motion(input.id != nullptr ? input.id->ids().at(x, y) : 0);
    const Hit hit = hit_of(now, input, x, y);
    if (!hit.sampled || !surface.traceable || !mirrored.traceable) return;
    const Receiver receiver = frame.receiver(x, y);
    const glm::dvec4 hit_then =
        hit.now.w > 0 ? glm::dvec4(mirrored.point_then(glm::dvec3(hit.now)), 1) : hit.now;
    const auto image_then = project(frame.previous.view.pixel_from_relative,
                                    virtual_image(hit_then, receiver.point, receiver.normal));
    if (!image_then.in_front) return;
    const glm::dvec2 pixel(x + 0.5, y + 0.5), centre(image_then.x, image_then.y);
    glm::dvec2 at = centre;
    if (rule == GlossyRule::kRelative) {
      if (surface.at_rest && mirrored.at_rest) return;  // as the surface
      const auto image = project(now.view.pixel_from_relative,
                                 virtual_image(hit.now, now.position(x, y), now.normal_at(x, y)));
      if (!image.in_front) return;
      at = pixel + centre - glm::dvec2(image.x, image.y);
    }
    if (rule == GlossyRule::kStochastic) at = scattered(frame, receiver, hit, key, x, y, centre);
    Taps taps = taps_of(frame, receiver, x, y, at);
    if (rule == GlossyRule::kStochastic && !taps.any()) {
      at = centre;
      taps = taps_of(frame, receiver, x, y, at);
    }
    if (!taps.any()) return;
    out.at(x, y) = taps;
    out.move(x, y, at - pixel);
    out.trust.at(x, y) = 1;
  });
  return out;
}

}  // namespace holdfast::oracle
