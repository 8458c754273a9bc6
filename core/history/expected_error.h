#pragma once

#include "core/history/component_history.h"
#include "core/history/light_change.h"
#include "core/spatial/window.h"

namespace holdfast {

/// Constants of the blend by expected error. All ours; tuned on fence and cylinder at two speeds.
struct ExpectedErrorRule {
  int window_step = 3;             ///< window of the bias estimate: 3 + 2 step pixels wide
  float window_precision = 0.15f;  ///< of its footprint, in that of the effect's: it leaves out
                                   ///< what other penumbrae do; tuned on fence and cylinder
  float noise_threshold = 0.2f;    ///< share of a window mean's variance that is not taken for bias
  float slow_threshold = 3.0f;     ///< added where a shadow moves slowly over its surface ...
  float slow_move = 0.05f;         ///< ... falling by 1/e with this much of a penumbra a frame
  float rest_threshold = 20.0f;    ///< added where it does not move at all ...
  float rest_move = 0.003f;        ///< ... falling by 1/e with this much (rounding, not sliding)
  float spatial_samples =
      40;  ///< samples that the spatial filter adds: it averages noise, not bias
  float surface_advantage =
      10;                   ///< the surface vector must promise this much less error to replace
                            ///< the shadow vector: the smallest of two estimates flatters itself
  float most_samples = 64;  ///< cap of the samples credited to history
  LightChangeRule change;   ///< where that is found, history is left
};

/// Scratch of `blend_by_expected_error`.
struct BlendScratch {
  Channels<float> candidates;   ///< values of surface and shadow, then their samples
  Channels<float> differences;  ///< candidate minus noisy
  Channels<float> bias;         ///< their local means
  ActivityMap activity;         ///< of the differences
  LightChange change;

  BlendScratch() = default;
  BlendScratch(int width, int height, Memory memory = Memory::kOwned)
      : candidates(width, height, 4, memory),
        differences(width, height, 2, memory),
        bias(width, height, 2, memory),
        activity(width, height),
        change(width, height) {}
  static void each_image(auto& s, auto&& visit) {
    for (auto* images : {&s.candidates, &s.differences, &s.bias}) visit(*images);
  }
};

/// Blends a visibility with the candidate history of least expected error. For a candidate h with n
/// samples, sample variance v, and local mean difference d = mean(h - noisy) over a window
/// of m samples:
///   u   = (v + v/n) / m                    variance of d
///   b^2 = max(0, d^2 - threshold u)        squared bias; the threshold falls to noise_threshold
///                                          the more of its penumbra a shadow moves a frame
///   s   = b^2 / (b^2 + u)                  share of d that is worth subtracting: h' = h - s d,
///                                          kept within 0..max(h, 1)
///   e   = v/n + spatial_samples ((1-s)^2 b^2 + s^2 u)
/// and with k = v/e (capped):  out = (noisy + k h') / (1 + k),  1/N_out = 1/(1+k)^2 +
/// (k/(1+k))^2/n' with n' = max(n, k). Bias counts `spatial_samples` times, because the spatial
/// filter that follows averages noise away, and bias not. Without a candidate, out = noisy and N =
/// 1, so that a history that fits nowhere leaves exactly the spatial filter; nor is there one in
/// the shadow of an object that has just appeared.
/// With a `footprint` (see counted_window_means) the window follows it; null: a square.
///   reads noisy, `before`, `sample_variance` | writes `now`, `debug` (may be null) | halo of the
///   window
void blend_by_expected_error(const Guides& guides, const Channels<float>& noisy,
                             const HistorySources& sources,
                             ChannelView<const float> sample_variance,
                             const Channels<float>* footprint, const ExpectedErrorRule& rule,
                             const ComponentHistory& before, BlendScratch& scratch,
                             WindowScratch& window, ComponentHistory& now, Channels<float>* debug);

}  // namespace holdfast
