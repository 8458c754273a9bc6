#include <algorithm>
#include <cmath>

#include "core/motion/follow_block.h"
#include "core/oracle/candidates.h"
#include "core/oracle/changes.h"
#include "core/oracle/filter_pass.h"

namespace holdfast::oracle {
namespace {

/// One candidate history of all pixels.
struct Candidate {
  const Past* past;
  Image value, samples;  ///< the frame's value and 0 where there is none
  Image difference;      ///< value minus frame
  Image mean_difference;

  Candidate(const Image& noisy, const Past* followed, const History& before)
      : past(followed), value(noisy), samples(noisy.width(), noisy.height(), 1) {
    difference = samples;
    if (past == nullptr) return;
    for_each_pixel(noisy.width(), noisy.height(), [&](int x, int y) {
      const Taps& taps = past->at(x, y);
      if (!taps.any()) return;
      value.at(x, y) = taps.read(before.signal);
      samples.at(x, y) = taps.read(before.samples);
      difference.at(x, y) = value.at(x, y) - noisy.at(x, y);
    });
  }
};

/// What a candidate promises at one pixel.
struct Promise {
  double error, correction;
};

Promise promise_of(const Candidate& candidate, int x, int y, double variance, double spread,
                   double threshold, const ExpectedErrorRule& rule) {
  const double n = candidate.samples.at(x, y), d = candidate.mean_difference.at(x, y);
  const double own = variance / (n > 0 ? n : 1);
  const double u = (variance + own) * spread;
  const double bias2 = std::max(0.0, d * d - threshold * u);
  const double s = bias2 / (bias2 + u);
  return {own + double{rule.spatial_samples} * (square(1 - s) * bias2 + s * s * u), s};
}

/// The less a shadow moves over its surface, in widths of its penumbra, the larger a difference
/// must be to be bias.
double threshold_of(const Sources& sources, bool has_shadow, const ExpectedErrorRule& rule, int x,
                    int y) {
  if (sources.effect == nullptr) return double{rule.noise_threshold};
  double move = sources.effect->sweep.at(x, y);
  if (has_shadow) {
    double slide_px = 0;
    for (int axis = 0; axis < 2; ++axis)
      slide_px +=
          std::abs(sources.effect->motion.at(x, y, axis) - sources.surface->motion.at(x, y, axis));
    move = move * slide_px / std::max(move + slide_px, 1e-9);
  }
  return double{rule.noise_threshold} +
         double{rule.slow_threshold} * std::exp(-move / double{rule.slow_move}) +
         double{rule.rest_threshold} * std::exp(-move / double{rule.rest_move});
}

}  // namespace

Blended blend_visibility(const Surfaces& now, const Image& noisy, const Sources& sources,
                         const Image& sample_variance, const Image* footprint,
                         const ExpectedErrorRule& rule, const History& before) {
  Blended out(now.width, now.height, 1);
  Candidate surface(noisy, sources.surface, before), shadow(noisy, sources.effect, before);
  Changes changes(now.width, now.height);
  if (rule.change.noticed)
    changes = Changes(now, surface.value, surface.difference, surface.samples, rule.change, false);
  out.changed_share = changes.share();
  Image spread;
  for (Candidate* candidate : {&surface, &shadow}) {
    Filtered window = window_means(now, candidate->difference, rule.window_step, footprint,
                                   double{rule.window_precision});
    candidate->mean_difference = std::move(window.values);
    spread = std::move(window.spread);
    for_each_pixel(now.width, now.height, [&](int x, int y) {
      const bool appeared =
          sources.effect != nullptr && !(sources.effect->sweep.at(x, y) < double{kAppearedSweep});
      if (changes.changed(x, y) || appeared) candidate->samples.at(x, y) = 0;
    });
  }
  const double most = double{rule.most_samples};
  for_each_pixel(now.width, now.height, [&](int x, int y) {
    const bool has_surface = surface.samples.at(x, y) > 0, has_shadow = shadow.samples.at(x, y) > 0;
    const double variance = sample_variance.at(x, y);
    const double threshold = threshold_of(sources, has_shadow, rule, x, y);
    const Promise of_surface =
        promise_of(surface, x, y, variance, spread.at(x, y), threshold, rule);
    const Promise of_shadow = promise_of(shadow, x, y, variance, spread.at(x, y), threshold, rule);
    const bool by_shadow =
        has_shadow &&
        (!has_surface || of_shadow.error < double{rule.surface_advantage} * of_surface.error);
    out.now.signal.at(x, y) = noisy.at(x, y);
    out.now.samples.at(x, y) = 1;
    if (!has_surface && !has_shadow) return;
    const Candidate& chosen = by_shadow ? shadow : surface;
    const Promise promise = by_shadow ? of_shadow : of_surface;
    const double h = chosen.value.at(x, y), n = chosen.samples.at(x, y);
    const double corrected =
        std::clamp(h - promise.correction * chosen.mean_difference.at(x, y), 0.0, std::max(h, 1.0));
    const double k = std::min(variance / promise.error, most - 1);
    const double alpha = 1 / (1 + k);
    out.now.signal.at(x, y) = alpha * noisy.at(x, y) + (1 - alpha) * corrected;
    const double samples = 1 / (square(alpha) + square(1 - alpha) / std::max(n, k));
    out.now.samples.at(x, y) = std::clamp(samples, 1.0, most);
    out.record(x, y, *chosen.past, n, 1 - alpha);
  });
  return out;
}

}  // namespace holdfast::oracle
