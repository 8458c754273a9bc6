#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/oracle/candidates.h"
#include "core/oracle/changes.h"
#include "core/oracle/filter_pass.h"

namespace holdfast::oracle {
namespace {

using Colour = glm::dvec3;

Colour colour_at(const Image& image, int x, int y) {
  return {image.at(x, y, 0), image.at(x, y, 1), image.at(x, y, 2)};
}

void set_colour(Image& image, int x, int y, const Colour& colour) {
  for (int c = 0; c < 3; ++c) image.at(x, y, c) = colour[c];
}

/// What one pixel follows: where it leads, and for the record along which vectors.
struct Lead {
  const Past* past = nullptr;
  Taps taps;
};

/// The candidate of a pixel that follows the surface, or what stands in for it; and the second,
/// which follows the effect beside it.
Lead lead_of(const Sources& sources, bool substitutes, int k, int x, int y) {
  const bool effect =
      sources.effect != nullptr && (substitutes ? !sources.surface->at(x, y).any() : k == 1);
  const Past* past = effect ? sources.effect : sources.surface;
  return {past, past->at(x, y)};
}

/// One candidate history of all pixels.
struct Candidate {
  Image value, samples;  ///< the frame's value and 0 where there is none
  Image difference;      ///< R, G, B of value minus frame, and their squared length
  Filtered means;        ///< of the differences
};

Candidate read_candidate(const Image& noisy, const Sources& sources, bool substitutes, int k,
                         const History& before) {
  Candidate out{
      noisy, Image(noisy.width(), noisy.height(), 1), Image(noisy.width(), noisy.height(), 4), {}};
  for_each_pixel(noisy.width(), noisy.height(), [&](int x, int y) {
    const Taps taps = lead_of(sources, substitutes, k, x, y).taps;
    if (!taps.any()) return;
    out.samples.at(x, y) = taps.read(before.samples);
    for (int c = 0; c < 3; ++c) {
      out.value.at(x, y, c) = taps.read(before.signal, c);
      out.difference.at(x, y, c) = out.value.at(x, y, c) - noisy.at(x, y, c);
      out.difference.at(x, y, 3) += square(out.difference.at(x, y, c));
    }
  });
  return out;
}

/// What a candidate promises at one pixel.
struct Promise {
  double samples = 0;  ///< 0: there is no candidate
  double error = 0, variance = 0, correction = 0;
  Colour bias{0};
};

Promise promise_of(const Candidate& candidate, const RadianceBlendRule& rule, double threshold,
                   double expected, int x, int y) {
  Promise out;
  out.samples = candidate.samples.at(x, y);
  const double n = out.samples > 0 ? out.samples : 1;
  const Colour d = colour_at(candidate.means.values, x, y);
  const double square_mean = candidate.means.values.at(x, y, 3);
  const Colour h = colour_at(candidate.value, x, y);
  const double rounding = 1e-10 * glm::dot(h, h);
  const double of_difference =
      std::max(square_mean - glm::dot(d, d), 1e-6 * square_mean + rounding + 1e-30);
  out.variance = of_difference * n / (n + 1);
  const double u = of_difference * candidate.means.spread.at(x, y);
  const double bias2 = std::max({0.0, glm::dot(d, d) - threshold * u, expected * of_difference});
  const double s = bias2 / (bias2 + u);
  out.bias = d;
  out.correction = s;
  out.error = out.variance / n + double{rule.spatial_samples} * (square(1 - s) * bias2 + s * s * u);
  return out;
}

}  // namespace

Blended blend_radiance(const Surfaces& now, const Image& noisy, const Sources& sources,
                       const Image* footprint, const RadianceBlendRule& rule, bool at_rest,
                       const History& before) {
  Blended out(now.width, now.height, 3);
  const bool substitutes = rule.effect_substitutes;
  const int count = sources.effect != nullptr && !substitutes ? 2 : 1;
  Candidate candidates[2];
  for (int k = 0; k < count; ++k) {
    candidates[k] = read_candidate(noisy, sources, substitutes, k, before);
    candidates[k].means = window_means(now, candidates[k].difference, rule.window_step, footprint,
                                       double{rule.window_precision});
  }
  std::vector<Changes> changes;  // by candidate; at rest the first one's is that of all
  for (int k = 0; k < count; ++k)
    if (!rule.change.noticed)
      changes.emplace_back(now.width, now.height);
    else if (at_rest && k > 0)
      changes.push_back(changes[0]);
    else
      changes.emplace_back(now, candidates[k].value, candidates[k].difference,
                           candidates[k].samples, rule.change, !at_rest);
  out.changed_share = changes[0].share();
  for_each_pixel(now.width, now.height, [&](int x, int y) {
    const bool rests = at_rest && !changes[0].changed(x, y);
    const double threshold = double{rests ? rule.rest_threshold : rule.threshold};
    int chosen = 0;
    Lead lead = lead_of(sources, substitutes, 0, x, y);
    Promise promise = promise_of(candidates[0], rule, threshold, changes[0].bias(x, y), x, y);
    if (count == 2) {
      const Lead other = lead_of(sources, substitutes, 1, x, y);
      const Promise second =
          promise_of(candidates[1], rule, threshold, changes[1].bias(x, y), x, y);
      if (second.samples > 0 &&
          (!(promise.samples > 0) || second.error < double{rule.second_share} * promise.error)) {
        chosen = 1;
        lead = other;
        promise = second;
      }
    }
    set_colour(out.now.signal, x, y, colour_at(noisy, x, y));
    out.now.samples.at(x, y) = 1;
    if (!(promise.samples > 0)) return;
    const double k = std::min(promise.variance / promise.error, double{rule.most_samples} - 1);
    const double alpha = 1 / (1 + k);
    const Colour given = colour_at(candidates[chosen].value, x, y);
    const Colour h = glm::max(given - promise.correction * promise.bias, Colour(0));
    set_colour(out.now.signal, x, y, alpha * colour_at(noisy, x, y) + (1 - alpha) * h);
    out.now.samples.at(x, y) = 1 + k;
    out.record(x, y, *lead.past, promise.samples, 1 - alpha);
  });
  return out;
}

}  // namespace holdfast::oracle
