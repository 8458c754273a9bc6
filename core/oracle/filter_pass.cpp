#include "core/oracle/filter_pass.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace holdfast::oracle {
namespace {

constexpr double kNormalPower = 128;  // SVGF sec. 4.3

/// The negative logarithm of what tap (qx, qy) loses for pixel (x, y).
double exponent(const Surfaces& s, const Pass& pass, int x, int y, int qx, int qy) {
  const glm::dvec3 normal = s.normal_at(x, y);
  const double distance = std::abs(glm::dot(normal, s.position(qx, qy) - s.position(x, y)));
  const double cosine = glm::dot(normal, s.normal_at(qx, qy));
  double sum = distance / (pass.step * s.pixel_width(s.depth.at(x, y))) +
               kNormalPower * std::max(1 - cosine, 0.0);
  if (pass.luminance != nullptr)
    sum += std::abs(pass.luminance->at(qx, qy) - pass.luminance->at(x, y)) *
           pass.inverse_sigma->at(x, y);
  if (pass.footprint != nullptr) {
    const double dx = qx - x, dy = qy - y;
    sum += pass.footprint_precision *
           (pass.footprint->at(x, y, 0) * dx * dx + 2 * pass.footprint->at(x, y, 1) * dx * dy +
            pass.footprint->at(x, y, 2) * dy * dy);
  }
  return sum;
}

void filter_pixel(const Surfaces& s, const Image& values, const Image& spread, const Pass& pass,
                  int x, int y, Filtered& out) {
  const bool by_samples = pass.weighting == Weighting::kSamples;
  double weights = 0, spreads = 0, sums[kMostFilterChannels] = {};
  for (int ky = -pass.radius; ky <= pass.radius; ++ky)
    for (int kx = -pass.radius; kx <= pass.radius; ++kx) {
      if (pass.diamond && std::abs(kx) + std::abs(ky) > pass.radius) continue;
      const int qx = x + kx * pass.step, qy = y + ky * pass.step;
      if (!s.inside(qx, qy) || !s.any(qx, qy)) continue;
      const double h = pass.kernel[std::abs(kx)] * pass.kernel[std::abs(ky)];
      const double g = h * std::exp(-exponent(s, pass, x, y, qx, qy));
      const double behind = spread.at(qx, qy), weight = by_samples ? g * behind : g;
      weights += weight;
      spreads += g * g * behind;
      for (int c = 0; c < values.channels(); ++c) sums[c] += weight * values.at(qx, qy, c);
    }
  if (!(weights > 0)) return;
  for (int c = 0; c < values.channels(); ++c) out.values.at(x, y, c) = sums[c] / weights;
  out.spread.at(x, y) = by_samples ? weights * weights / spreads : spreads / (weights * weights);
}

}  // namespace

Filtered filter_pass(const Surfaces& surfaces, const Image& values, const Image& spread,
                     const Pass& pass) {
  Filtered out{values, spread};
  for_each_pixel(surfaces.width, surfaces.height, [&](int x, int y) {
    if (surfaces.any(x, y)) filter_pixel(surfaces, values, spread, pass, x, y, out);
  });
  return out;
}

Pass box_pass(int step) { return {.radius = 1, .kernel = {1, 1, 0}, .step = step}; }

Pass tent_pass(int step) { return {.radius = 1, .kernel = {0.5, 0.25, 0}, .step = step}; }

Pass kernel_pass(int taps, int step) {
  if (taps == 9) return tent_pass(step);
  if (taps == 13) return {.radius = 2, .diamond = true, .kernel = {1, 0.8, 0.4}, .step = step};
  return {.step = step};
}

Filtered window_means(const Surfaces& surfaces, const Image& values, int second_step,
                      const Image* footprint, double footprint_precision) {
  Pass pass = box_pass(1);
  pass.footprint = footprint;
  pass.footprint_precision = footprint_precision;
  const Image ones(surfaces.width, surfaces.height, 1, 1.0);
  const Filtered between = filter_pass(surfaces, values, ones, pass);
  pass.step = second_step;
  return filter_pass(surfaces, between.values, between.spread, pass);
}

}  // namespace holdfast::oracle
