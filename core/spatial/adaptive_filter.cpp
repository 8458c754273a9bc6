#include "core/spatial/adaptive_filter.h"

#include <cassert>
#include <span>
#include <utility>

#include "core/kernels/parallel.h"
#include "core/spatial/filter_rows.h"

namespace holdfast {
namespace {

constexpr float kRestTolerance = 1e-6f;  // of the signal; rounding of what is constant

/// Zones of the activity map, one a pass. What the last level of `levels` writes differs from its
/// input within the reach of all levels; what comes before it must be exact, spread included, as
/// far as later passes look.
class Zones {
 public:
  Zones(int levels, int radius) : levels_(levels) {
    const int reach = radius * ((1 << levels) - 1);
    int halo = reach;
    for (int level = levels - 1; level >= 0; --level) {
      halos_[levels - 1 - level] = halo;
      halo += level > 0 ? radius << level : 0;
    }
    halos_[levels] = halo;          // the second pass of the luminance, of step 2
    halos_[levels + 1] = halo + 2;  // the first
  }
  int of_level(int level) const { return levels_ - 1 - level; }
  int of_first_level() const { return levels_ - 1; }
  int of_luminance(int pass) const { return levels_ + 1 - pass; }
  std::span<const int> halos() const { return {halos_, static_cast<std::size_t>(levels_ + 2)}; }

 private:
  int levels_;
  int halos_[kMostLevels + 2];
};

/// Narrows the footprint by a local mean of the samples: precision times samples^(1/4).
void narrow_footprint(const Guides& guides, const Signal& signal, const Zones& zones,
                      TapWeights& weights, FilterScratch& s) {
  FilterPass pass;
  pass.guides = &guides;
  pass.kept = &weights;
  pass.weights = {.radius = 1, .kernel = {1, 1, 1}};
  pass.step = 2;
  pass.channels = 1;
  pass.activity = &s.activity;
  pass.activity_zone = zones.of_first_level();
  pass.spread = Spread::kNone;
  pass.in[0] = signal.samples;
  pass.out[0] = s.guide[2];
  const Channels<float>& footprint = *signal.footprint;
  for_each_row(guides.view.height, [&](int y) {
    filter_row(pass, y);
    narrow_row({{footprint[0].row(y), footprint[1].row(y), footprint[2].row(y)},
                s.guide[2].row(y),
                guides.view.width,
                {s.footprint[0].row(y), s.footprint[1].row(y), s.footprint[2].row(y)}});
  });
}

/// Fills guide[0] with a local mean of the luminance and guide[1] with its inverse tolerance.
void prepare_luminance(const Guides& guides, const Signal& signal, float luminance_sigma,
                       const Zones& zones, TapWeights& weights, FilterScratch& s) {
  const int width = guides.view.width, height = guides.view.height;
  const Channels<float>& values = *signal.values;
  ChannelView<const float> luminance = values[0];
  if (signal.channels == 3) {
    luminance = std::as_const(s.guide)[0];
    for_each_row(height, [&](int y) {
      luminance_row({{values[0].row(y), values[1].row(y), values[2].row(y)},
                     3,
                     width,
                     s.guide[0].row(y),
                     nullptr});
    });
  }
  FilterPass pass;
  pass.guides = &guides;
  pass.weights = {.radius = 1, .kernel = {0.5f, 0.25f, 0.0f}};
  pass.kept = &weights;
  pass.channels = 1;
  pass.activity = &s.activity;
  pass.spread = Spread::kSamples;
  if (signal.footprint != nullptr)
    for (int c = 0; c < 3; ++c) pass.footprint[c] = (*signal.footprint)[c];
  pass.activity_zone = zones.of_luminance(0);
  pass.in[0] = luminance;
  pass.out[0] = s.guide[2];
  pass.spread_in = signal.samples;
  pass.spread_out = s.spread[1];
  filter_image(pass);
  pass.activity_zone = zones.of_luminance(1);
  pass.step = 2;
  pass.in[0] = std::as_const(s.guide)[2];
  pass.out[0] = s.guide[0];
  pass.spread_in = std::as_const(s.spread)[1];
  pass.spread_out = s.spread[0];
  for_each_row(height, [&](int y) {
    filter_row(pass, y);
    tolerance_row({s.guide[0].row(y), signal.sample_variance.row(y), s.spread[0].row(y),
                   luminance_sigma, width, s.guide[1].row(y)});
  });
}

}  // namespace

FilterWeights kernel_of(int taps) {
  switch (taps) {
    case 9: return {.radius = 1, .kernel = {0.5f, 0.25f, 0.0f}};
    case 13: return {.radius = 2, .diamond = true, .kernel = {1.0f, 0.8f, 0.4f}};
    default: assert(taps == 25); return {};
  }
}

void adaptive_filter(const Guides& guides, const Signal& signal,
                     const AdaptiveFilterSettings& settings, TapWeights& weights, FilterScratch& s,
                     Plane& out) {
  assert(settings.levels >= 1 && settings.levels <= kMostLevels);
  ChannelView<const float> values[3];
  for (int c = 0; c < signal.channels; ++c) values[c] = (*signal.values)[c];
  const FilterWeights kernel = kernel_of(settings.taps);
  const Zones zones(settings.levels, kernel.radius);
  s.activity.measure(guides, {values, static_cast<std::size_t>(signal.channels)}, zones.halos(),
                     kRestTolerance);
  prepare_luminance(guides, signal, settings.luminance_sigma, zones, weights, s);
  if (signal.footprint != nullptr) narrow_footprint(guides, signal, zones, weights, s);

  FilterPass pass;
  pass.guides = &guides;
  pass.weights = kernel;
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
    pass.activity_zone = zones.of_level(level);
    pass.spread_in = level == 0 ? signal.samples : std::as_const(s.spread)[level % 2];
    pass.spread_out = s.spread[1 - level % 2];
    filter_image(pass);
  }
}

}  // namespace holdfast
