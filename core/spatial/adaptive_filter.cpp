#include "core/spatial/adaptive_filter.h"

#include <cmath>
#include <utility>

#include "core/kernels/parallel.h"

namespace holdfast {
namespace {

constexpr int kLuminanceReach = 3;       // px, of the two passes that prepare the luminance
constexpr float kRestTolerance = 1e-6f;  // absolute; rounding of a constant visibility

/// Narrows the footprint by a local mean of the samples: precision times samples^(1/4).
void narrow_footprint(const Guides& guides, const Signal& signal, FilterScratch& s) {
  FilterRow pass;
  pass.guides = &guides;
  pass.weights = {.radius = 1, .kernel = {1, 1, 1}};
  pass.step = 2;
  pass.channels = 1;
  pass.activity = &s.activity;
  pass.spread = Spread::kVariance;
  pass.in[0] = signal.samples;
  pass.out[0] = s.guide[2];
  pass.spread_in = signal.samples;
  pass.spread_out = s.spread[1];  // not used
  filter_image(pass);
  for_each_row(guides.view.height, [&](int y) {
    const float* samples = s.guide[2].row(y);
    for (int c = 0; c < 3; ++c) {
      const float* in = (*signal.footprint)[c].row(y);
      float* to = s.footprint[c].row(y);
      for (int x = 0; x < guides.view.width; ++x) to[x] = in[x] * std::sqrt(std::sqrt(samples[x]));
    }
  });
}

/// Fills guide[0] with a local mean of the luminance and guide[1] with its inverse tolerance.
void prepare_luminance(const Guides& guides, const Signal& signal, float luminance_sigma,
                       FilterScratch& s) {
  const int width = guides.view.width, height = guides.view.height;
  for_each_row(height, [&](int y) {
    for (int x = 0; x < width; ++x) s.guide[0].at(x, y) = signal.luminance_at(x, y);
  });
  FilterRow pass;
  pass.guides = &guides;
  pass.weights = {.radius = 1, .kernel = {0.5f, 0.25f, 0.0f}};
  pass.channels = 1;
  pass.activity = &s.activity;
  pass.spread = Spread::kSamples;
  if (signal.footprint != nullptr)
    for (int c = 0; c < 3; ++c) pass.footprint[c] = (*signal.footprint)[c];
  for (int level = 0; level < 2; ++level) {
    pass.step = 1 << level;
    pass.in[0] = std::as_const(s.guide)[level == 0 ? 0 : 2];
    pass.out[0] = s.guide[level == 0 ? 2 : 0];
    pass.spread_in = level == 0 ? signal.samples : std::as_const(s.spread)[1];
    pass.spread_out = s.spread[level == 0 ? 1 : 0];
    filter_image(pass);
  }
  for_each_row(height, [&](int y) {
    for (int x = 0; x < width; ++x) {
      const float mean = s.guide[0].at(x, y);
      const float sd = std::sqrt(signal.sample_variance.at(x, y) / s.spread[0].at(x, y));
      // The second term keeps rounding of a noise-free signal from counting as an edge.
      s.guide[1].at(x, y) = 1.0f / (luminance_sigma * sd + 1e-3f * std::abs(mean) + 1e-12f);
    }
  });
}

}  // namespace

void adaptive_filter(const Guides& guides, const Signal& signal,
                     const AdaptiveFilterSettings& settings, FilterScratch& s, Plane& out) {
  ChannelView<const float> values[3];
  for (int c = 0; c < signal.channels; ++c) values[c] = (*signal.values)[c];
  // Twice the reach of all passes: beyond it, nothing that a copied tile leaves out can matter.
  const int reach = 2 * ((1 << settings.levels) - 1) + kLuminanceReach;
  s.activity.measure(guides, {values, static_cast<std::size_t>(signal.channels)}, 2 * reach,
                     kRestTolerance);
  prepare_luminance(guides, signal, settings.luminance_sigma, s);
  if (signal.footprint != nullptr) narrow_footprint(guides, signal, s);

  FilterRow pass;
  pass.guides = &guides;
  pass.channels = signal.channels;
  pass.activity = &s.activity;
  pass.spread = Spread::kSamples;
  pass.luminance = std::as_const(s.guide)[0];
  pass.inverse_luminance_sigma = std::as_const(s.guide)[1];
  if (signal.footprint != nullptr)
    for (int c = 0; c < 3; ++c) pass.footprint[c] = std::as_const(s.footprint)[c];
  for (int level = 0; level < settings.levels; ++level) {
    const Channels<float>& from = level == 0 ? *signal.values : (level % 2 == 1 ? s.even : s.odd);
    Channels<float>& to = level % 2 == 0 ? s.even : s.odd;
    for (int c = 0; c < signal.channels; ++c) {
      pass.in[c] = from[c];
      pass.out[c] = level + 1 == settings.levels ? out.channel(c) : to[c];
    }
    pass.step = 1 << level;
    pass.spread_in = level == 0 ? signal.samples : std::as_const(s.spread)[level % 2];
    pass.spread_out = s.spread[1 - level % 2];
    filter_image(pass);
  }
}

}  // namespace holdfast
