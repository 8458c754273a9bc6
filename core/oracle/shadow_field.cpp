#include <algorithm>
#include <cmath>

#include "core/motion/effect_field.h"
#include "core/oracle/shadows.h"

namespace holdfast::oracle {
namespace {

// Variance of the footprint: of the cast shape times half axis^2, and of a pixel, px^2.
constexpr double kCastVariance = 0.5 / 3;
constexpr double kPixelVariance = 0.5;

/// How the pixel position of a point moves with the point: rows of d(x, y) / d(metres).
struct PixelDerivative {
  glm::dvec3 x, y;

  PixelDerivative(const glm::dmat4& pixel_from_relative, const glm::dvec3& point) {
    const glm::dmat4 rows = glm::transpose(pixel_from_relative);
    const glm::dvec4 h = pixel_from_relative * glm::dvec4(point, 1);
    x = (glm::dvec3(rows[0]) - h.x / h.w * glm::dvec3(rows[3])) / h.w;
    y = (glm::dvec3(rows[1]) - h.y / h.w * glm::dvec3(rows[3])) / h.w;
  }
};

/// Covariance xx, xy, yy of the light's shape as the blocker casts it onto the receiver's plane.
/// With t the way from light to blocker, a half axis A of the light moves the shadow by
///   tau (-A + (A.n) t / (t.n)),   tau = distance of the receiver / |t|, both along the ray
glm::dvec3 cast_covariance(const Surfaces& now, const ShadowInput& input, int x, int y,
                           const glm::dvec3& to_light, double ratio, double light_w) {
  const glm::dvec3 normal = now.normal_at(x, y);
  const PixelDerivative pixel(now.view.pixel_from_relative, now.position(x, y));
  const double tau = ratio / std::max(1 - light_w * ratio, 1e-3);
  const glm::dmat3 half_axes = glm::dmat3(input.places.now) * light_half_axes(input.light);
  glm::dvec3 sum(kPixelVariance, 0, kPixelVariance);
  for (int k = 0; k < 3; ++k) {
    const glm::dvec3 axis = half_axes[k];
    const glm::dvec3 move =
        tau * (-axis + glm::dot(axis, normal) * to_light / glm::dot(to_light, normal));
    const double dx = glm::dot(pixel.x, move), dy = glm::dot(pixel.y, move);
    sum += kCastVariance * glm::dvec3(dx * dx, dx * dy, dy * dy);
  }
  return sum;
}

}  // namespace

bool ShadowInput::blocked(const Surfaces& now, int x, int y) const {
  const double blocker_m = double{distance.channel(0).at(x, y)};
  return now.any(x, y) && blocker_m >= 0 && std::isfinite(blocker_m);
}

Image shadow_field(const Surfaces& now, const ShadowInput& input) {
  Image out(now.width, now.height, kEffectFieldChannels);
  for_each_pixel(now.width, now.height, [&](int x, int y) {
    if (!input.blocked(now, x, y)) return;
    const glm::dvec4 light = input.places.now * input.own_sample(x, y);
    const glm::dvec3 to_light = glm::dvec3(light) - light.w * now.position(x, y);
    const double light_m = glm::length(to_light);
    if (!(glm::dot(to_light, now.normal_at(x, y)) > 1e-4 * light_m)) return;
    const double ratio = double{input.distance.channel(0).at(x, y)} / light_m;
    const glm::dvec3 c = cast_covariance(now, input, x, y, to_light, ratio, light.w);
    const double scale = 0.5 / std::max(c.x * c.z - c.y * c.y, 1e-12);
    out.at(x, y, kFieldValid) = 1;
    out.at(x, y, kFieldRatio) = ratio;
    out.at(x, y, kFieldPrecision) = c.z * scale;
    out.at(x, y, kFieldPrecision + 1) = -c.y * scale;
    out.at(x, y, kFieldPrecision + 2) = c.x * scale;
  });
  return out;
}

}  // namespace holdfast::oracle
