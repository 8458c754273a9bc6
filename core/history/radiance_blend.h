#pragma once

#include "core/history/component_history.h"
#include "core/history/light_change.h"
#include "core/spatial/window.h"

namespace holdfast {

/// Constants of the blend of radiance by expected error. Thresholds are in variances of the
/// difference that they are held against. All ours; tuned on occluder, glossy-floor and static.
struct RadianceBlendRule {
  bool effect_substitutes = false;  ///< the effect's history stands in only where the surface
                                    ///< has none, rather than beside it
  int window_step = 2;              ///< window of a difference: 3 + 2 step pixels wide
  float window_precision = 3.0f;    ///< of its footprint, in that of the effect's: it must find
                                    ///< what the filter's would blur
  float threshold = 2.0f;           ///< of the difference, which is taken for noise below
  float rest_threshold = 300.0f;    ///< the same where nothing in the scene moves: there is little
                                    ///< reason to expect bias
  float spatial_samples = 40.0f;    ///< that the spatial filter adds: noise averages, bias not
  float second_share = 0.9f;        ///< of the first candidate's error: below it the second one is
                                    ///< taken; nearer ones are told apart by chance
  float most_samples = 64.0f;       ///< cap of the samples credited to history
  LightChangeRule change;  ///< where that is found, a scene at rest counts as if it moved, and
                           ///< history is expected to be biased
};

/// Scratch of `blend_radiance`: for each candidate, R, G, B and samples; differences to the frame
/// R, G, B and their square; local means of those.
struct RadianceBlendScratch {
  static constexpr int kPerCandidate = 4, kMostCandidates = 2;
  Channels<float> candidates, differences[kMostCandidates], means;
  ActivityMap activity;                 ///< of the differences
  LightChange change[kMostCandidates];  ///< by candidate; at rest the first one's is that of all

  RadianceBlendScratch() = default;
  RadianceBlendScratch(int width, int height, int most_candidates, Memory memory = Memory::kOwned)
      : candidates(width, height, kPerCandidate * most_candidates, memory),
        means(width, height, kPerCandidate * most_candidates, memory),
        activity(width, height) {
    for (int k = 0; k < most_candidates; ++k) {
      differences[k] = Channels<float>(width, height, kPerCandidate, memory);
      change[k] = LightChange(width, height);
    }
  }
  static void each_image(auto& s, auto&& visit) {
    for (auto* images : {&s.candidates, &s.differences[0], &s.differences[1], &s.means})
      visit(*images);
  }
};

/// Blends RGB radiance with the candidate history of least expected error (the second one if that
/// is below second_share of the first one's). For a candidate h with n
/// samples, d = mean(h - noisy) by channel over a window of m samples, and variance
/// v' = mean |h - noisy|^2 - |d|^2 of one difference (summed over channels, so that changes of hue
/// count; at least that of 1e-5 of h, below which differences are rounding), v = v' n / (n + 1)
/// that of one sample:
///   u   = v' / m                                  variance of d
///   b^2 = the larger of max(0, |d|^2 - threshold u) and c v', c what LightChange expects of the
///         history there
///   s   = b^2 / (b^2 + u)                         share worth subtracting: h' = h - s d
///   e   = v/n + spatial_samples ((1-s)^2 b^2 + s^2 u)
/// and with k = v/e (capped):  out = (noisy + k h') / (1 + k), N_out = 1 + k: samples count by the
/// error they leave, bias included, so that the spatial filter leans on what is right. Without a
/// candidate, out = noisy and N = 1. `at_rest`: neither camera, objects nor lights have moved.
/// The window keeps within the `footprint` (may be null) of the effect.
///   reads noisy, `before` | writes `now`, `debug` (may be null) | halo of the window
void blend_radiance(const Guides& guides, const Channels<float>& noisy,
                    const HistorySources& sources, const Channels<float>* footprint,
                    const RadianceBlendRule& rule, bool at_rest, const ComponentHistory& before,
                    RadianceBlendScratch& scratch, WindowScratch& window, ComponentHistory& now,
                    Channels<float>* debug);

}  // namespace holdfast
