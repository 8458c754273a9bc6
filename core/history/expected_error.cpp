#include "core/history/expected_error.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/kernels/math.h"
#include "core/kernels/parallel.h"

namespace holdfast {
namespace {

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

/// The candidates of a pixel: for one channel the surface's and the shadow's histories, for three
/// the surface's alone.
void gather_candidates(const Guides& guides, const Channels<float>& noisy,
                       const HistorySources& sources, const ComponentHistory& before,
                       BlendScratch& s) {
  const int channels = before.channels;
  for_each_row(guides.view.height, [&](int y) {
    for (int x = 0; x < guides.view.width; ++x) {
      const auto take = [&](const Taps& taps, int channel, int value_slot, int samples_slot) {
        const bool any = taps.any();
        const float current = noisy[channel].at(x, y);
        const float value = any ? gather(before.data[channel], taps) : current;
        s.candidates[value_slot].at(x, y) = value;
        s.differences[value_slot].at(x, y) = value - current;
        s.candidates[samples_slot].at(x, y) = any ? gather(before.samples(), taps) : 0.0f;
      };
      const Taps& surface = sources.surface->taps[0].at(x, y);
      if (channels == 3) {
        for (int c = 0; c < 3; ++c) take(surface, c, c, 3);
      } else {
        take(surface, 0, 0, 2);
        take(sources.effect != nullptr ? sources.effect->taps[0].at(x, y) : Taps{}, 0, 1, 3);
      }
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
    const bool radiance = now.channels == 3;
    const float* variance = sample_variance.row(y);
    const float* spread = window_spread.row(y);
    const float* bias[3] = {s.bias[0].row(y), s.bias[1].row(y), s.bias[2].row(y)};
    const float* candidates[4] = {s.candidates[0].row(y), s.candidates[1].row(y),
                                  s.candidates[2].row(y), s.candidates[3].row(y)};
    float* samples_out = now.samples().row(y);
    for (int x = 0; x < noisy.width(); ++x) {
      int slot = 0;  // of the chosen candidate's first value
      Estimate chosen;
      if (radiance) {
        chosen = estimate(candidates[3][x], luminance(bias[0][x], bias[1][x], bias[2][x]),
                          variance[x], spread[x], rule.noise_threshold, rule);
      } else {
        const bool shadow_there = candidates[3][x] > 0.0f;
        const float threshold =
            shadow_there ? threshold_of(slide_px(x, y), rule) : rule.noise_threshold;
        chosen = estimate(candidates[2][x], bias[0][x], variance[x], spread[x], threshold, rule);
        const Estimate shadow =
            estimate(candidates[3][x], bias[1][x], variance[x], spread[x], threshold, rule);
        if (shadow_there &&
            (chosen.samples <= 0.0f || shadow.error < rule.surface_advantage * chosen.error)) {
          chosen = shadow;
          slot = 1;
        }
      }
      float alpha = 1.0f, samples = 1.0f;
      if (chosen.samples > 0.0f) {
        const float k = std::min(variance[x] / chosen.error, rule.most_samples - 1.0f);
        alpha = 1.0f / (1.0f + k);
        samples = 1.0f / (square(alpha) + square(1.0f - alpha) / std::max(chosen.samples, k));
      }
      for (int c = 0; c < now.channels; ++c) {
        // A correction may not leave the range of the signal: radiance is not negative, visibility
        // stays within 0..1 or what it was.
        const float given = candidates[slot + c][x];
        const float most = radiance ? given + std::abs(bias[slot + c][x]) : std::max(given, 1.0f);
        const float h = std::clamp(given - chosen.correction * bias[slot + c][x], 0.0f, most);
        now.data[c].at(x, y) = alpha * noisy[c].at(x, y) + (1.0f - alpha) * h;
      }
      samples_out[x] = std::clamp(samples, 1.0f, rule.most_samples);
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
    const Channels<float>& motion = slot == 1 ? sources.effect->motion : sources.surface->motion;
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
  const int channels = now.channels;
  gather_candidates(guides, noisy, sources, before, s);
  const int count = channels == 3 ? 3 : 2;
  ChannelView<const float> differences[3];
  for (int c = 0; c < count; ++c) differences[c] = std::as_const(s.differences)[c];
  s.activity.measure(guides, {differences, static_cast<std::size_t>(count)}, 1 + rule.window_step,
                     0.0f, true);
  const auto spread =
      window_means(guides, s.differences, count, rule.window_step, window, s.bias, 0, &s.activity);
  const Blend blend{noisy, sources, sample_variance, spread, rule, s, now, debug};
  for_each_row(guides.view.height, [&](int y) { blend.row(y); });
}

}  // namespace holdfast
