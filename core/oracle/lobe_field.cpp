#include <algorithm>
#include <cmath>

#include "core/frame/conventions.h"
#include "core/motion/effect_field.h"
#include "core/motion/glossy_motion.h"
#include "core/oracle/reflections.h"

namespace holdfast::oracle {
namespace {

// Variance of the footprint, in terms of the lobe's and of pixels.
constexpr double kLobeVariance = 0.5;
constexpr double kPixelVariance = 2.5;  // px^2

}  // namespace

Image lobe_field(const Surfaces& now, const ReflectionInput& input) {
  Image out(now.width, now.height, kEffectFieldChannels);
  const double focal_px = 1 / now.view.pixel_angle;
  for_each_pixel(now.width, now.height, [&](int x, int y) {
    const double hit_m = double{input.distance.channel(0).at(x, y)};
    bool sampled = false;
    for (int axis = 0; axis < 3; ++axis) sampled |= input.direction.channel(axis).at(x, y) != 0.0f;
    if (!now.any(x, y) || !sampled || !(hit_m >= 0)) return;
    const glm::dvec3 point = now.position(x, y), normal = now.normal_at(x, y);
    const double view_m = glm::length(point);
    const double cosine = std::abs(glm::dot(point, normal)) / std::max(view_m, 1e-20);
    const auto spread = glossy_spread(focal_px, ggx_alpha_from_roughness(now.roughness_at(x, y)),
                                      view_m, hit_m, cosine);
    const glm::dvec2 along = incidence_axis(now.view.pixel_from_relative, point, normal);
    const double in = kLobeVariance * square(spread.in_plane);
    const double across = kLobeVariance * square(spread.out_of_plane);
    const double xx = kPixelVariance + in * square(along.x) + across * square(along.y);
    const double yy = kPixelVariance + in * square(along.y) + across * square(along.x);
    const double xy = (in - across) * along.x * along.y;
    const double scale = 0.5 / (xx * yy - xy * xy);
    out.at(x, y, kFieldValid) = 1;
    out.at(x, y, kFieldPrecision) = yy * scale;
    out.at(x, y, kFieldPrecision + 1) = -xy * scale;
    out.at(x, y, kFieldPrecision + 2) = xx * scale;
  });
  return out;
}

}  // namespace holdfast::oracle
