#include "core/history/expected_error.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/kernels/math.h"
#include "core/kernels/parallel.h"

namespace holdfast {
namespace {

// Candidates: values, then samples.
constexpr int kSurface = 0, kShadow = 1, kSamples = 2;

/// What a candidate promises at one pixel.
struct Estimate {
  float error = 0;       ///< expected squared error, in units in which a sample's is its variance
  float correction = 0;  ///< share of the local mean difference to subtract, 0..1
  float samples = 0;     ///< 0: no candidate
};

Estimate estimate(float samples, float difference, float variance, float window_spread,
                  float threshold, const ExpectedErrorRule& rule) {
  if (!(samples > 0.0f)) return {};
  const float own = variance / samples;
  const float noise = (variance + own) * window_spread;
  const float bias = std::max(difference * difference - threshold * noise, 0.0f);
  const float share = bias / (bias + noise);
  const float left = bias * square(1.0f - share) + noise * square(share);
  return {own + rule.spatial_samples * left, share, samples};
}

/// The threshold where a shadow moves over its surface by `slide_px` pixels: at rest there is no
/// reason to expect bias, so that only a large difference counts; the faster, the sooner.
float threshold_of(float slide_px, const ExpectedErrorRule& rule) {
  return rule.noise_threshold + rule.slow_threshold * exp_nonpositive(-slide_px / rule.slow_px) +
         rule.rest_threshold * exp_nonpositive(-slide_px / rule.rest_px);
}

/// The candidates of every pixel: value and samples of the surface's history, then of the shadow's.
void gather_candidates(const Guides& guides, const Channels<float>& noisy,
                       const HistorySources& sources, const ComponentHistory& before,
                       BlendScratch& s) {
  for_each_row(guides.view.height, [&](int y) {
    for (int x = 0; x < guides.view.width; ++x) {
      const auto take = [&](const Taps& taps, int slot) {
        const bool any = taps.any();
        const float current = noisy[0].at(x, y);
        const float value = any ? gather(before.data[0], taps) : current;
        s.candidates[slot].at(x, y) = value;
        s.differences[slot].at(x, y) = value - current;
        s.candidates[kSamples + slot].at(x, y) = any ? gather(before.samples(), taps) : 0.0f;
      };
      take(sources.surface->taps[0].at(x, y), kSurface);
      take(sources.effect != nullptr ? sources.effect->taps[0].at(x, y) : Taps{}, kShadow);
    }
  });
}

/// The last step: chooses the candidate of each pixel and blends.
struct Blend {
  const Channels<float>& noisy;
  const HistorySources& sources;
  ChannelView<const float> sample_variance, window_spread;
  const ExpectedErrorRule& rule;
  const BlendScratch& s;
  ComponentHistory& now;
  Channels<float>* debug;

  void row(int y) const {
    const float* variance = sample_variance.row(y);
    const float* spread = window_spread.row(y);
    const float* bias[2] = {s.bias[kSurface].row(y), s.bias[kShadow].row(y)};
    const float* samples_of[2] = {s.candidates[kSamples + kSurface].row(y),
                                  s.candidates[kSamples + kShadow].row(y)};
    for (int x = 0; x < noisy.width(); ++x) {
      int slot = kSurface;
      const bool shadow_there = samples_of[kShadow][x] > 0.0f;
      const float threshold =
          shadow_there ? threshold_of(slide_px(x, y), rule) : rule.noise_threshold;
      const float kept = s.change.changed(x, y) ? 0.0f : 1.0f;
      Estimate chosen = estimate(kept * samples_of[kSurface][x], bias[kSurface][x], variance[x],
                                 spread[x], threshold, rule);
      const Estimate shadow = estimate(kept * samples_of[kShadow][x], bias[kShadow][x], variance[x],
                                       spread[x], threshold, rule);
      if (shadow_there &&
          (chosen.samples <= 0.0f || shadow.error < rule.surface_advantage * chosen.error)) {
        chosen = shadow;
        slot = kShadow;
      }
      float alpha = 1.0f, samples = 1.0f;
      if (chosen.samples > 0.0f) {
        const float k = std::min(variance[x] / chosen.error, rule.most_samples - 1.0f);
        alpha = 1.0f / (1.0f + k);
        samples = 1.0f / (square(alpha) + square(1.0f - alpha) / std::max(chosen.samples, k));
      }
      // A correction may not leave the range of a visibility: 0..1, or what it was.
      const float given = s.candidates[slot].at(x, y);
      const float h =
          std::clamp(given - chosen.correction * bias[slot][x], 0.0f, std::max(given, 1.0f));
      now.data[0].at(x, y) = alpha * noisy[0].at(x, y) + (1.0f - alpha) * h;
      now.samples().at(x, y) = std::clamp(samples, 1.0f, rule.most_samples);
      if (debug != nullptr) record(x, y, slot, chosen.samples, 1.0f - alpha);
    }
  }

  /// Motion of the shadow over its surface at (x, y), pixels.
  float slide_px(int x, int y) const {
    const Channels<float>&shadow = sources.effect->motion, &surface = sources.surface->motion;
    return std::abs(shadow[0].at(x, y) - surface[0].at(x, y)) +
           std::abs(shadow[1].at(x, y) - surface[1].at(x, y));
  }

  void record(int x, int y, int slot, float samples, float trust) const {
    const Channels<float>& motion =
        slot == kShadow ? sources.effect->motion : sources.surface->motion;
    (*debug)[kDebugX].at(x, y) = motion[0].at(x, y);
    (*debug)[kDebugY].at(x, y) = motion[1].at(x, y);
    (*debug)[kDebugFrames].at(x, y) = samples;
    (*debug)[kDebugTrust].at(x, y) = trust;
  }
};

}  // namespace

void blend_by_expected_error(const Guides& guides, const Channels<float>& noisy,
                             const HistorySources& sources,
                             ChannelView<const float> sample_variance,
                             const ExpectedErrorRule& rule, const ComponentHistory& before,
                             BlendScratch& s, WindowScratch& window, ComponentHistory& now,
                             Channels<float>* debug) {
  gather_candidates(guides, noisy, sources, before, s);
  const ChannelView<const float> differences[2] = {std::as_const(s.differences)[kSurface],
                                                   std::as_const(s.differences)[kShadow]};
  if (rule.change.noticed)  // by the surface's: nothing moves
    s.change.measure(guides, {s.candidates, s.differences, kSurface, 1, kSamples + kSurface},
                     rule.change);
  else
    s.change.clear();
  s.activity.measure(guides, differences, 1 + rule.window_step, 0.0f, true);
  const auto spread =
      window_means(guides, s.differences, 2, rule.window_step, window, s.bias, 0, &s.activity);
  const Blend blend{noisy, sources, sample_variance, spread, rule, s, now, debug};
  for_each_row(guides.view.height, [&](int y) { blend.row(y); });
}

}  // namespace holdfast
