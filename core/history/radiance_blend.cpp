#include "core/history/radiance_blend.h"

#include <algorithm>
#include <utility>

#include "core/history/radiance_blend_kernel.h"
#include "core/kernels/parallel.h"

namespace holdfast {
namespace {

constexpr int kStep = RadianceBlendScratch::kPerCandidate;
constexpr int kSquare = 3;           // of a difference
constexpr int kSamples = kStep - 1;  // channel of a candidate

/// The candidates of each pixel, and what they are blended with.
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

  /// Taps of candidate `k` from (x, y) on; written to `own` where they are of both kinds.
  const Taps* taps_of(int k, int x, int y, int count, Taps* own) const {
    const Taps* surface = sources.surface->taps[0].row(y) + x;
    if (sources.effect == nullptr) return surface;
    if (rule.effect_substitutes)
      return sources.surface->taps_or(sources.effect->taps, x, y, count, own);
    return k == 1 ? sources.effect->taps[0].row(y) + x : surface;
  }

  void read_row(int y) const {
    Taps own[kTapBlock];
    for (int x = 0; x < noisy.width(); x += kTapBlock) {
      const int count = std::min(kTapBlock, noisy.width() - x);
      for (int k = 0; k < candidates(); ++k) {
        const Taps* taps = taps_of(k, x, y, count, own);
        if (k == 0 || any(taps, count))
          read_candidate({taps, k, x, y, count, noisy, before, s});
        else
          leave_out(k, x, y, count);
      }
    }
  }

  static bool any(const Taps* taps, int count) {
    return std::any_of(taps, taps + count, [](const Taps& each) { return each.any(); });
  }

  /// A candidate that no pixel of the block has: its values will not be looked at.
  void leave_out(int k, int x, int y, int count) const {
    std::fill_n(s.candidates[kStep * k + kSamples].row(y) + x, count, 0.0f);
    for (int c = 0; c < kStep; ++c) std::fill_n(s.differences[k][c].row(y) + x, count, 0.0f);
  }

  /// Marks the tiles in which a candidate differs from the frame: most of an image has no
  /// reflection, then and now. Elsewhere the means are those of zeros.
  void find_activity(const Guides& guides) const {
    ChannelView<const float> squares[RadianceBlendScratch::kMostCandidates];
    for (int k = 0; k < candidates(); ++k) squares[k] = std::as_const(s.differences[k])[kSquare];
    s.activity.measure(guides, {squares, static_cast<std::size_t>(candidates())},
                       1 + rule.window_step, 0.0f, true);
  }

  /// In a scene at rest of the first candidate: the others lead nowhere else.
  void look_for_changes(const Guides& guides) const {
    for (int k = 0; k < candidates(); ++k) {
      if (!rule.change.noticed || (at_rest && k > 0))
        s.change[k].clear();
      else if (at_rest)
        s.change[k].measure(signal_of(guides, k), rule.change);
      else
        s.change[k].measure_moving(signal_of(guides, k), rule.change);
    }
  }

  TileSignal signal_of(const Guides& guides, int k) const {
    const Channels<float>& values = s.candidates;
    TileSignal signal{guides, {}, values[kStep * k + kSamples], {}, 3};
    for (int c = 0; c < 3; ++c) {
      signal.history[c] = values[kStep * k + c];
      signal.noisy[c] = noisy[c];
    }
    return signal;
  }

  void blend_row(int y, const float* spread) const {
    Taps own[kTapBlock];
    float chosen[kTapBlock], samples[kTapBlock], weight[kTapBlock];
    float expected[RadianceBlendScratch::kMostCandidates][kTapBlock];
    for (int x = 0, count = 0; x < noisy.width(); x += count) {
      count = s.change[0].run(x, y, std::min(kTapBlock, noisy.width() - x));
      const bool rests = at_rest && !s.change[0].changed(x, y);
      const bool two = candidates() == 2 && any(taps_of(1, x, y, count, own), count);
      for (int k = 0; k < candidates(); ++k) {
        const LightChange& change = s.change[at_rest ? 0 : k];
        change.biases(x, y, count, expected[k]);
      }
      blend_candidates({two ? 2 : 1,
                        x,
                        y,
                        count,
                        noisy,
                        s,
                        spread + x,
                        {expected[0], expected[1]},
                        rule,
                        rests ? rule.rest_threshold : rule.threshold,
                        now,
                        chosen,
                        samples,
                        weight});
      if (debug == nullptr) continue;
      for (int i = 0; i < count; ++i)
        record(x + i, y, chosen[i] > 0.0f ? 1 : 0, samples[i], weight[i]);
    }
  }

  void record(int x, int y, int k, float samples, float weight) const {
    const Channels<float>& motion =
        follows_effect(k, x, y) ? sources.effect->motion : sources.surface->motion;
    const bool used = samples > 0.0f;  // not where light has changed
    (*debug)[kDebugX].at(x, y) = used ? motion[0].at(x, y) : 0.0f;
    (*debug)[kDebugY].at(x, y) = used ? motion[1].at(x, y) : 0.0f;
    (*debug)[kDebugFrames].at(x, y) = samples;
    (*debug)[kDebugTrust].at(x, y) = weight;
  }
};

}  // namespace

void blend_radiance(const Guides& guides, const Channels<float>& noisy,
                    const HistorySources& sources, const Channels<float>* footprint,
                    const RadianceBlendRule& rule, bool at_rest, const ComponentHistory& before,
                    RadianceBlendScratch& s, WindowScratch& window, ComponentHistory& now,
                    Channels<float>* debug) {
  const RadianceBlend pass{noisy, sources, rule, at_rest, before, s, now, debug};
  for_each_row(guides.view.height, [&](int y) { pass.read_row(y); });
  pass.look_for_changes(guides);
  pass.find_activity(guides);
  ChannelView<const float> spread;
  for (int k = 0; k < pass.candidates(); ++k)
    spread =
        counted_window_means(guides, s.differences[k], kStep, rule.window_step, window, s.means,
                             kStep * k, &s.activity, footprint, rule.window_precision);
  for_each_row(guides.view.height, [&](int y) { pass.blend_row(y, spread.row(y)); });
}

}  // namespace holdfast
