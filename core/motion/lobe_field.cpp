#include "core/motion/lobe_field.h"

#include <cmath>

#include "core/frame/conventions.h"
#include "core/kernels/parallel.h"
#include "core/motion/glossy_motion.h"

namespace holdfast {
namespace {

// Variance of the filter's footprint, in terms of the lobe's and of pixels: wider costs sharpness,
// narrower leaves noise. Ours, tuned on glossy-floor.
constexpr float kLobeVariance = 0.5f;
constexpr float kPixelVariance = 2.5f;  // px^2

}  // namespace

void measure_lobes(const Guides& now, const GlossyPlanes& planes, Channels<float>& out, int first) {
  const glm::mat4 pixel(now.view.pixel_from_relative);
  const float focal_px = 1.0f / static_cast<float>(now.view.pixel_angle);
  for_each_row(now.view.height, [&](int y) {
    for (int x = 0; x < now.view.width; ++x) {
      float field[kEffectFieldChannels] = {};
      const float hit_m = planes.distance->channel(0).at(x, y);
      const bool sampled = planes.direction->channel(0).at(x, y) != 0.0f ||
                           planes.direction->channel(1).at(x, y) != 0.0f ||
                           planes.direction->channel(2).at(x, y) != 0.0f;
      if (now.depth().at(x, y) > 0.0f && sampled && hit_m >= 0.0f) {
        const glm::vec3 s = now.position_at(x, y), n = now.normal_at(x, y);
        const float view_m = glm::length(s);
        const float cosine = std::abs(glm::dot(s, n)) / std::max(view_m, 1e-20f);
        const auto spread = glossy_spread(
            focal_px, ggx_alpha_from_roughness(now.roughness_at(x, y)), view_m, hit_m, cosine);
        const glm::vec2 a = incidence_axis(pixel, s, n);
        const float in = kLobeVariance * spread.in_plane * spread.in_plane;
        const float across = kLobeVariance * spread.out_of_plane * spread.out_of_plane;
        const glm::vec3 precision = precision_of_covariance(
            kPixelVariance + in * a.x * a.x + across * a.y * a.y, (in - across) * a.x * a.y,
            kPixelVariance + in * a.y * a.y + across * a.x * a.x);
        field[kFieldValid] = 1.0f;
        for (int k = 0; k < 3; ++k) field[kFieldPrecision + k] = precision[k];
      }
      for (int c = 0; c < kEffectFieldChannels; ++c) out[first + c].at(x, y) = field[c];
    }
  });
}

}  // namespace holdfast
