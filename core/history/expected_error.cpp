#include "core/history/expected_error.h"

#include <algorithm>
#include <utility>

#include "core/history/expected_error_kernel.h"
#include "core/kernels/parallel.h"

namespace holdfast {
namespace {

// Candidates: values, then samples.
constexpr int kSurface = 0, kShadow = 1, kSamples = 2;

/// The candidates of every pixel: value and samples of the surface's history, then of the shadow's.
void gather_candidates(const Guides& guides, const Channels<float>& noisy,
                       const HistorySources& sources, const ComponentHistory& before,
                       BlendScratch& s) {
  const int width = guides.view.width;
  for_each_row(guides.view.height, [&](int y) {
    const Taps none[kTapBlock] = {};
    for (int x = 0; x < width; x += kTapBlock) {
      const int count = std::min(kTapBlock, width - x);
      for (const int slot : {kSurface, kShadow}) {
        const Taps* taps = slot == kSurface            ? sources.surface->taps[0].row(y) + x
                           : sources.effect != nullptr ? sources.effect->taps[0].row(y) + x
                                                       : none;
        read_visibility({taps, count, before, noisy[0].row(y) + x, s.candidates[slot].row(y) + x,
                         s.differences[slot].row(y) + x, s.candidates[kSamples + slot].row(y) + x});
      }
    }
  });
}

/// Where light has changed, there are no candidates.
void drop_changed(BlendScratch& s) {
  if (!(s.change.share() > 0)) return;
  for_each_row(s.candidates.height(), [&](int y) {
    for (const int slot : {kSurface, kShadow}) {
      float* samples = s.candidates[kSamples + slot].row(y);
      for (int x = 0; x < s.candidates.width(); ++x)
        if (s.change.changed(x, y)) samples[x] = 0.0f;
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
    float chosen[kTapBlock], history[kTapBlock], weight[kTapBlock];
    for (int x = 0; x < noisy.width(); x += kTapBlock) {
      const int count = std::min(kTapBlock, noisy.width() - x);
      VisibilityBlend block{count,
                            rule,
                            noisy[0].row(y) + x,
                            sample_variance.row(y) + x,
                            window_spread.row(y) + x,
                            {},
                            {},
                            {},
                            {},
                            {},
                            nullptr,
                            now.data[0].row(y) + x,
                            now.samples().row(y) + x,
                            chosen,
                            history,
                            weight};
      for (const int slot : {kSurface, kShadow}) {
        block.value[slot] = s.candidates[slot].row(y) + x;
        block.samples[slot] = s.candidates[kSamples + slot].row(y) + x;
        block.bias[slot] = s.bias[slot].row(y) + x;
      }
      if (sources.effect != nullptr) {
        for (const int axis : {kMotionX, kMotionY}) {
          block.shadow_motion[axis] = sources.effect->motion[axis].row(y) + x;
          block.surface_motion[axis] = sources.surface->motion[axis].row(y) + x;
        }
        block.sweep = sources.effect->motion[kMotionSweep].row(y) + x;
      }
      blend_visibility(block);
      if (debug == nullptr) continue;
      for (int i = 0; i < count; ++i)
        record(x + i, y, chosen[i] > 0.0f ? kShadow : kSurface, history[i], weight[i]);
    }
  }

  void record(int x, int y, int slot, float samples, float trust) const {
    const Channels<float>& motion =
        slot == kShadow ? sources.effect->motion : sources.surface->motion;
    const bool used = samples > 0.0f;  // not where light comes for the first time
    (*debug)[kDebugX].at(x, y) = used ? motion[0].at(x, y) : 0.0f;
    (*debug)[kDebugY].at(x, y) = used ? motion[1].at(x, y) : 0.0f;
    (*debug)[kDebugFrames].at(x, y) = samples;
    (*debug)[kDebugTrust].at(x, y) = trust;
  }
};

}  // namespace

void blend_by_expected_error(const Guides& guides, const Channels<float>& noisy,
                             const HistorySources& sources,
                             ChannelView<const float> sample_variance,
                             const Channels<float>* footprint, const ExpectedErrorRule& rule,
                             const ComponentHistory& before, BlendScratch& s, WindowScratch& window,
                             ComponentHistory& now, Channels<float>* debug) {
  gather_candidates(guides, noisy, sources, before, s);
  const ChannelView<const float> differences[2] = {std::as_const(s.differences)[kSurface],
                                                   std::as_const(s.differences)[kShadow]};
  if (rule.change.noticed) {  // by the surface's: nothing moves
    const Channels<float>& values = s.candidates;
    s.change.measure({guides, {values[kSurface]}, values[kSamples + kSurface], {noisy[0]}, 1},
                     rule.change);
    drop_changed(s);
  } else {
    s.change.clear();
  }
  s.activity.measure(guides, differences, 1 + rule.window_step, 0.0f, true);
  const auto spread =
      counted_window_means(guides, s.differences, 2, rule.window_step, window, s.bias, 0,
                           &s.activity, footprint, rule.window_precision);
  const Blend blend{noisy, sources, sample_variance, spread, rule, s, now, debug};
  for_each_row(guides.view.height, [&](int y) { blend.row(y); });
}

}  // namespace holdfast
