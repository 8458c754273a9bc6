#include "core/history/expected_error.h"

#include <algorithm>
#include <cmath>

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

/// The threshold of a pixel: a shadow that stays on its surface gives no reason to expect bias, so
/// that only a large difference counts; the more it slides, the sooner.
float noise_threshold(const HistorySources& sources, const ExpectedErrorRule& rule, int channels,
                      int x, int y) {
  if (channels == 3 || sources.shadow == nullptr || !sources.shadow->taps[0].at(x, y).any())
    return rule.noise_threshold;
  const float dx = sources.shadow->motion[0].at(x, y) - sources.surface->motion[0].at(x, y);
  const float dy = sources.shadow->motion[1].at(x, y) - sources.surface->motion[1].at(x, y);
  const float slide_px = std::abs(dx) + std::abs(dy);
  return rule.noise_threshold + rule.slow_threshold * std::exp(-slide_px / rule.slow_px) +
         rule.rest_threshold * std::exp(-slide_px / rule.rest_px);
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
        take(sources.shadow != nullptr ? sources.shadow->taps[0].at(x, y) : Taps{}, 0, 1, 3);
      }
    }
  });
}

}  // namespace

void blend_by_expected_error(const Guides& guides, const Channels<float>& noisy,
                             const HistorySources& sources,
                             ChannelView<const float> sample_variance,
                             const ExpectedErrorRule& rule, const ComponentHistory& before,
                             BlendScratch& s, WindowScratch& window, ComponentHistory& now,
                             Channels<float>* debug) {
  const int channels = now.channels;
  gather_candidates(guides, noisy, sources, before, s);
  const auto spread = window_means(guides, s.differences, channels == 3 ? 3 : 2, rule.window_step,
                                   window, s.bias);
  for_each_row(guides.view.height, [&](int y) {
    for (int x = 0; x < guides.view.width; ++x) {
      const float variance = sample_variance.at(x, y), window_spread = spread.at(x, y);
      const float threshold = noise_threshold(sources, rule, channels, x, y);
      const auto promise = [&](int samples_slot, float difference) {
        return estimate(s.candidates[samples_slot].at(x, y), difference, variance, window_spread,
                        threshold, rule);
      };
      int slot = 0;  // of the chosen candidate's first value
      Estimate chosen;
      if (channels == 3) {
        chosen = promise(3, luminance(s.bias[0].at(x, y), s.bias[1].at(x, y), s.bias[2].at(x, y)));
      } else {
        chosen = promise(2, s.bias[0].at(x, y));
        const Estimate shadow = promise(3, s.bias[1].at(x, y));
        if (shadow.samples > 0.0f &&
            (chosen.samples <= 0.0f || shadow.error < rule.surface_advantage * chosen.error)) {
          chosen = shadow;
          slot = 1;
        }
      }
      float alpha = 1.0f, samples = 1.0f;
      if (chosen.samples > 0.0f) {
        const float k = std::min(variance / chosen.error, rule.most_samples - 1.0f);
        alpha = 1.0f / (1.0f + k);
        samples = 1.0f / (square(alpha) + square(1.0f - alpha) / std::max(chosen.samples, k));
      }
      for (int c = 0; c < channels; ++c) {
        const float h = s.candidates[slot + c].at(x, y) -
                        chosen.correction * s.bias[slot + c].at(x, y);
        now.data[c].at(x, y) = alpha * noisy[c].at(x, y) + (1.0f - alpha) * h;
      }
      now.samples().at(x, y) = std::clamp(samples, 1.0f, rule.most_samples);
      if (debug != nullptr) {
        const Channels<float>& motion = slot == 1 ? sources.shadow->motion : sources.surface->motion;
        (*debug)[kDebugX].at(x, y) = motion[0].at(x, y);
        (*debug)[kDebugY].at(x, y) = motion[1].at(x, y);
        (*debug)[kDebugFrames].at(x, y) = chosen.samples;
        (*debug)[kDebugTrust].at(x, y) = 1.0f - alpha;
      }
    }
  });
}

}  // namespace holdfast
