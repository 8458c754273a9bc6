#include "core/history/radiance_blend.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/kernels/math.h"
#include "core/kernels/parallel.h"

namespace holdfast {
namespace {

constexpr int kStep = RadianceBlendScratch::kPerCandidate;
constexpr int kSamples = 3;  // of a candidate
constexpr int kSquare = 3;   // of a difference

using Colour = std::array<float, 3>;

float norm2(const Colour& c) { return square(c[0]) + square(c[1]) + square(c[2]); }

/// A measured difference of history to the frame, and its variance, summed over channels.
struct Difference {
  Colour mean{};
  float variance = 0;
};

/// What a candidate promises at one pixel.
struct Promise {
  float samples = 0;     ///< 0: no candidate
  float error = 0;       ///< expected squared error
  float variance = 0;    ///< of one sample
  float correction = 0;  ///< share of `bias` to subtract, 0..1
  Difference bias;       ///< the difference that decides
  Difference residual;   ///< that of this frame joined with those before
};

/// Joins this frame's difference with the mean of those before, a recursive mean of weight `beta`
/// that starts as the plain mean.
Difference join(const Difference& before, const Difference& now, float beta) {
  if (!(before.variance > 0.0f)) return now;
  const float b = std::max(beta, before.variance / (before.variance + now.variance));
  Difference joined;
  for (std::size_t c = 0; c < 3; ++c)
    joined.mean[c] = (1.0f - b) * before.mean[c] + b * now.mean[c];
  joined.variance = square(1.0f - b) * before.variance + square(b) * now.variance;
  return joined;
}

float excess(const Difference& d, float threshold) {
  return std::max(norm2(d.mean) - threshold * d.variance, 0.0f);
}

Promise promise_of(float samples, const Colour& d, float square_mean, float spread,
                   const Difference& before, const RadianceBlendRule& rule, bool at_rest) {
  if (!(samples > 0.0f)) return {};
  Promise p;
  p.samples = samples;
  // The difference also holds the candidate's own noise.
  const float floor = 1e-6f * square_mean + 1e-20f;
  const float of_difference = std::max(square_mean - norm2(d), floor);
  p.variance = of_difference * samples / (samples + 1.0f);
  const Difference now{d, of_difference * spread};
  p.residual = join(before, now, rule.residual_beta);
  const float sudden = excess(now, at_rest ? rule.rest_sudden_threshold : rule.sudden_threshold);
  const float lasting = excess(p.residual, at_rest ? rule.rest_threshold : rule.noise_threshold);
  p.bias = sudden > lasting ? now : p.residual;
  const float bias = std::max(sudden, lasting), noise = p.bias.variance;
  p.correction = bias / (bias + noise);
  const float left = bias * square(1.0f - p.correction) + noise * square(p.correction);
  p.error = p.variance / samples + rule.spatial_samples * left;
  return p;
}

/// The pass over one frame: gathers the candidates, chooses one for each pixel, and blends.
struct RadianceBlend {
  const Channels<float>& noisy;
  const HistorySources& sources;
  const RadianceBlendRule& rule;
  bool at_rest;
  const ComponentHistory& before;
  RadianceBlendScratch& s;
  ComponentHistory& now;
  Channels<float>* debug;

  int candidates() const { return sources.effect != nullptr && !rule.effect_substitutes ? 2 : 1; }

  /// True where candidate `k` follows the effect's vector.
  bool follows_effect(int k, int x, int y) const {
    if (sources.effect == nullptr || !rule.effect_substitutes) return k == 1;
    return !sources.surface->taps[0].at(x, y).any();
  }

  const Taps& taps_of(int k, int x, int y) const {
    return (follows_effect(k, x, y) ? sources.effect->taps : sources.surface->taps)[0].at(x, y);
  }

  void gather_row(int k, int y) const {
    for (int x = 0; x < noisy.width(); ++x) {
      const Taps& t = taps_of(k, x, y);
      const bool any = t.any();
      float sum = 0;
      for (int c = 0; c < 3; ++c) {
        const float current = noisy[c].at(x, y);
        const float value = any ? gather(before.data[c], t) : current;
        s.candidates[kStep * k + c].at(x, y) = value;
        s.differences[c].at(x, y) = value - current;
        sum += square(value - current);
      }
      s.candidates[kStep * k + kSamples].at(x, y) = any ? gather(before.samples(), t) : 0.0f;
      s.differences[kSquare].at(x, y) = sum;
    }
  }

  Promise promise(int k, int x, int y, float spread) const {
    const float n = s.candidates[kStep * k + kSamples].at(x, y);
    if (!(n > 0.0f)) return {};
    const Taps& taps = taps_of(k, x, y);
    Colour d;
    Difference residual_before;
    for (int c = 0; c < 3; ++c) {
      d[static_cast<std::size_t>(c)] = s.means[kStep * k + c].at(x, y);
      residual_before.mean[static_cast<std::size_t>(c)] = gather(before.residual(c), taps);
    }
    residual_before.variance = gather(before.residual(3), taps);
    return promise_of(n, d, s.means[kStep * k + kSquare].at(x, y), spread, residual_before, rule,
                      at_rest && !s.change.changed(x, y));
  }

  /// Of the first candidate, which in a scene at rest leads nowhere else.
  void look_for_changes(const Guides& guides) const {
    if (at_rest && rule.change.noticed)
      s.change.measure(guides, {s.candidates, s.differences, 0, 3, kSamples}, rule.change);
    else
      s.change.clear();
  }

  void blend_row(int y, const float* spread) const {
    for (int x = 0; x < noisy.width(); ++x) {
      int k = 0;
      Promise chosen = promise(0, x, y, spread[x]);
      if (candidates() == 2) {
        const Promise effect = promise(1, x, y, spread[x]);
        if (effect.samples > 0.0f && (chosen.samples <= 0.0f || effect.error < chosen.error)) {
          chosen = effect;
          k = 1;
        }
      }
      blend(k, chosen, x, y);
    }
  }

  void blend(int k, const Promise& chosen, int x, int y) const {
    float weight = 0.0f;
    if (chosen.samples > 0.0f)
      weight = std::min(chosen.variance / chosen.error, rule.most_samples - 1.0f);
    const float alpha = 1.0f / (1.0f + weight);
    // What is subtracted from the history, or replaced by the frame, is no longer wrong with it.
    const float kept = (1.0f - alpha) * (1.0f - chosen.correction);
    for (int c = 0; c < 3; ++c) {
      const auto i = static_cast<std::size_t>(c);
      const float h =
          s.candidates[kStep * k + c].at(x, y) - chosen.correction * chosen.bias.mean[i];
      now.data[c].at(x, y) = alpha * noisy[c].at(x, y) + (1.0f - alpha) * std::max(h, 0.0f);
      now.residual(c).at(x, y) = kept * chosen.residual.mean[i];
    }
    now.residual(3).at(x, y) = chosen.residual.variance;
    now.samples().at(x, y) = 1.0f + weight;
    if (debug == nullptr) return;
    const Channels<float>& motion =
        follows_effect(k, x, y) ? sources.effect->motion : sources.surface->motion;
    (*debug)[kDebugX].at(x, y) = motion[0].at(x, y);
    (*debug)[kDebugY].at(x, y) = motion[1].at(x, y);
    (*debug)[kDebugFrames].at(x, y) = chosen.samples;
    (*debug)[kDebugTrust].at(x, y) = 1.0f - alpha;
  }
};

}  // namespace

void blend_radiance(const Guides& guides, const Channels<float>& noisy,
                    const HistorySources& sources, const Channels<float>* footprint,
                    const RadianceBlendRule& rule, bool at_rest, const ComponentHistory& before,
                    RadianceBlendScratch& s, WindowScratch& window, ComponentHistory& now,
                    Channels<float>* debug) {
  const RadianceBlend pass{noisy, sources, rule, at_rest, before, s, now, debug};
  ChannelView<const float> spread;
  for (int k = 0; k < pass.candidates(); ++k) {
    for_each_row(guides.view.height, [&](int y) { pass.gather_row(k, y); });
    if (k == 0) pass.look_for_changes(guides);
    spread = window_means(guides, s.differences, kStep, rule.window_step, window, s.means,
                          kStep * k, nullptr, footprint);
  }
  for_each_row(guides.view.height, [&](int y) { pass.blend_row(y, spread.row(y)); });
}

}  // namespace holdfast
