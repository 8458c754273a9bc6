#include "core/oracle/spatial.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "core/oracle/filter_pass.h"

namespace holdfast::oracle {
namespace {

Image luminance_of(const Image& signal) {
  Image out(signal.width(), signal.height(), 1);
  for_each_pixel(out.width(), out.height(),
                 [&](int x, int y) { out.at(x, y) = luminance_at(signal, x, y); });
  return out;
}

/// The footprint narrowed by what the pixels around have behind them: precision samples^(1/4).
Image narrowed(const Surfaces& now, const Image& footprint, const Image& samples) {
  const Image mean = filter_pass(now, samples, samples, box_pass(2)).values;
  Image out = footprint;
  for_each_pixel(out.width(), out.height(), [&](int x, int y) {
    for (int c = 0; c < 3; ++c) out.at(x, y, c) *= std::pow(mean.at(x, y), 0.25);
  });
  return out;
}

/// The luminance that stops the filter: two passes of 3x3, by samples, within the footprint.
Filtered guide_of(const Surfaces& now, const History& history, const Image* footprint) {
  Pass pass = tent_pass(1);
  pass.weighting = Weighting::kSamples;
  pass.footprint = footprint;
  const Filtered once = filter_pass(now, luminance_of(history.signal), history.samples, pass);
  pass.step = 2;
  return filter_pass(now, once.values, once.spread, pass);
}

Image inverse_tolerance(const Filtered& guide, const Image& variance, double sigma) {
  Image out(variance.width(), variance.height(), 1);
  for_each_pixel(out.width(), out.height(), [&](int x, int y) {
    out.at(x, y) = 1 / (sigma * std::sqrt(variance.at(x, y) / guide.spread.at(x, y)) +
                        1e-3 * std::abs(guide.values.at(x, y)) + 1e-20);
  });
  return out;
}

/// 3x3 Gaussian, borders repeated.
double smoothed(const Image& image, int x, int y) {
  double sum = 0;
  for (int j = -1; j <= 1; ++j)
    for (int i = -1; i <= 1; ++i)
      sum += (i == 0 ? 0.5 : 0.25) * (j == 0 ? 0.5 : 0.25) *
             image.at(std::clamp(x + i, 0, image.width() - 1),
                      std::clamp(y + j, 0, image.height() - 1));
  return sum;
}

/// Of the luminance, from its moments; from the neighbourhood while history is young.
Image variance_of_moments(const History& history, const Image& sample_variance) {
  constexpr double kYoung = 4;
  Image out(sample_variance.width(), sample_variance.height(), 1);
  for_each_pixel(out.width(), out.height(), [&](int x, int y) {
    const double frames = history.samples.at(x, y);
    double variance =
        std::max(history.moments.at(x, y, 1) - square(history.moments.at(x, y, 0)), 0.0);
    if (frames < kYoung - 0.5)
      variance = std::max(variance, sample_variance.at(x, y)) * kYoung / frames;
    out.at(x, y) = variance;
  });
  return out;
}

}  // namespace

Image filter_by_samples(const Surfaces& now, const History& history, const Statistics& statistics,
                        const AdaptiveFilterSettings& settings) {
  const Image* footprint = statistics.footprint ? &statistics.footprint : nullptr;
  const Filtered guide = guide_of(now, history, footprint);
  const Image tolerance =
      inverse_tolerance(guide, statistics.variance, double{settings.luminance_sigma});
  Image narrow;
  if (footprint != nullptr) narrow = narrowed(now, *footprint, history.samples);
  Filtered level{history.signal, history.samples};
  for (int k = 0; k < settings.levels; ++k) {
    Pass pass = kernel_pass(settings.taps, 1 << k);
    pass.weighting = Weighting::kSamples;
    pass.luminance = &guide.values;
    pass.inverse_sigma = &tolerance;
    if (footprint != nullptr) pass.footprint = &narrow;
    level = filter_pass(now, level.values, level.spread, pass);
  }
  return level.values;
}

Image filter_by_variance(const Surfaces& now, const Statistics& statistics, int levels,
                         History& history) {
  constexpr double kSigma = 4;  // SVGF sec. 4.4
  Filtered level{history.signal, variance_of_moments(history, statistics.variance)};
  for (int k = 0; k < levels; ++k) {
    const Image luminance = luminance_of(level.values);
    Image inverse(now.width, now.height, 1);
    for_each_pixel(now.width, now.height, [&](int x, int y) {
      inverse.at(x, y) = 1 / (kSigma * std::sqrt(smoothed(level.spread, x, y)) +
                              1e-4 * luminance.at(x, y) + 1e-20);
    });
    Pass pass{.step = 1 << k};
    pass.luminance = &luminance;
    pass.inverse_sigma = &inverse;
    level = filter_pass(now, level.values, level.spread, pass);
    if (k == 0) history.signal = level.values;
  }
  return level.values;
}

}  // namespace holdfast::oracle
