#include "core/oracle/exponential.h"

#include <algorithm>
#include <cmath>

#include "core/frame/plane_size.h"

namespace holdfast::oracle {
namespace {

using Colour = glm::dvec3;

Colour colour_at(const Image& image, int x, int y) {
  if (image.channels() == 1) return {image.at(x, y), 0, 0};
  return {image.at(x, y, 0), image.at(x, y, 1), image.at(x, y, 2)};
}

/// A value as it is; R, G, B as Y, Co, Cg.
Colour clampable(const Image& image, int x, int y) {
  const Colour v = colour_at(image, x, y);
  if (image.channels() == 1) return v;
  return {0.25 * v.r + 0.5 * v.g + 0.25 * v.b, 0.5 * v.r - 0.5 * v.b,
          -0.25 * v.r + 0.5 * v.g - 0.25 * v.b};
}

struct Bounds {
  Colour low, high;
};

/// What the surfaces among the 3x3 pixels around (x, y) allow.
Bounds bounds_of(const Surfaces& now, const Image& noisy, const AccumulationRule& rule, int x,
                 int y) {
  const Colour own = clampable(noisy, x, y);
  Bounds box{own, own};
  Colour sum(0), squares(0);
  double n = 0;
  for (int qy = y - 1; qy <= y + 1; ++qy)
    for (int qx = x - 1; qx <= x + 1; ++qx) {
      if (!now.inside(qx, qy) || !now.any(qx, qy)) continue;
      const Colour v = clampable(noisy, qx, qy);
      box = {glm::min(box.low, v), glm::max(box.high, v)};
      sum += v;
      squares += v * v;
      n += 1;
    }
  if (rule.rectification == Rectification::kClampBox) return box;
  const Colour mean = sum / n;
  const Colour sigma = glm::sqrt(glm::max(squares / n - mean * mean, Colour(0)));
  return {mean - double{rule.clamp_gamma} * sigma, mean + double{rule.clamp_gamma} * sigma};
}

/// Clamped per axis, colours that no longer exist brought back to 0.
Colour clamped(const Image& history, const Bounds& bounds) {
  const Colour v = glm::min(glm::max(clampable(history, 0, 0), bounds.low), bounds.high);
  if (history.channels() == 1) return v;
  return glm::max(Colour(v.x + v.y - v.z, v.x + v.z, v.x - v.y - v.z), Colour(0));
}

bool clamps(Rectification rectification, bool by_effect) {
  if (rectification == Rectification::kClampFallback) return !by_effect;
  return rectification != Rectification::kNone;
}

double mix(double weight, double noisy, double history) {
  return (1 - weight) * noisy + weight * history;
}

}  // namespace

Blended blend_exponentially(const Surfaces& now, const Image& noisy, const Sources& sources,
                            const AccumulationRule& rule, const History& before,
                            bool with_moments) {
  const double alpha = double{rule.alpha}, most = (2 - alpha) / alpha;
  const int channels = noisy.channels();
  Blended out(now.width, now.height, channels);
  if (with_moments) out.now.moments = Image(now.width, now.height, 2);
  for_each_pixel(now.width, now.height, [&](int x, int y) {
    const bool by_effect = sources.effect != nullptr && sources.effect->at(x, y).any();
    const Past* followed = by_effect ? sources.effect : sources.surface;
    const Taps taps = followed != nullptr ? followed->at(x, y) : Taps{};
    double trust = taps.any() ? 1 : 0;
    if (by_effect) trust *= sources.effect->trust.at(x, y);
    if (sources.antilag != nullptr) trust *= 1 - sources.antilag->at(x / kStratum, y / kStratum);

    Image history(1, 1, channels);
    if (taps.any())
      for (int c = 0; c < channels; ++c) history.at(0, 0, c) = taps.read(before.signal, c);
    const double n = taps.any() ? taps.read(before.samples) : 0;
    if (taps.any() && clamps(rule.rectification, by_effect)) {
      const Colour kept = clamped(history, bounds_of(now, noisy, rule, x, y));
      for (int c = 0; c < channels; ++c) history.at(0, 0, c) = kept[c];
    }
    const double weight = trust * (1 - std::max(alpha, 1 / (n + 1)));
    for (int c = 0; c < channels; ++c)
      out.now.signal.at(x, y, c) = mix(weight, noisy.at(x, y, c), history.at(0, 0, c));
    out.now.samples.at(x, y) = std::min(1 + trust * n, most);
    if (with_moments)
      for (int order = 0; order < 2; ++order)
        out.now.moments.at(x, y, order) =
            mix(weight, std::pow(luminance_at(noisy, x, y), order + 1),
                taps.any() ? taps.read(before.moments, order) : 0.0);
    if (taps.any()) out.record(x, y, *followed, n, weight);
  });
  return out;
}

}  // namespace holdfast::oracle
