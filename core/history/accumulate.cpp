#include "core/history/accumulate.h"

#include <algorithm>

#include "core/frame/plane_size.h"
#include "core/history/accumulate_kernel.h"
#include "core/kernels/parallel.h"

namespace holdfast {
namespace {

/// Whether history found along the effect's vector (or the surface's) is clamped.
bool clamps(Rectification rectification, bool by_effect) {
  return rectification == Rectification::kClampFallback ? !by_effect
                                                        : rectification != Rectification::kNone;
}

/// Room for what a block follows where that is of both kinds.
struct Choice {
  Taps taps[kTapBlock];
  float trust[kTapBlock], effect[kTapBlock];
};

/// Chooses what the pixels from (x, y) on follow.
AccumulationLanes choose(const HistorySources& sources, Rectification rectification, int x, int y,
                         int count, Choice& own) {
  static constexpr Taps kNone[kTapBlock] = {};
  const Taps* surface = sources.surface != nullptr ? sources.surface->taps[0].row(y) + x : kNone;
  AccumulationLanes lanes{surface, nullptr, nullptr, clamps(rectification, false),
                          clamps(rectification, true)};
  if (sources.effect != nullptr && sources.effect_stands_in) {
    lanes.taps = sources.surface->taps_or(sources.effect->taps, x, y, count, own.taps);
    if (lanes.taps == own.taps) {
      for (int i = 0; i < count; ++i)
        own.effect[i] = !surface[i].any() && own.taps[i].any() ? 1.0f : 0.0f;
      lanes.effect = own.effect;
    }
  } else if (sources.effect != nullptr) {
    const Taps* effect = sources.effect->taps[0].row(y) + x;
    const float* trust = sources.effect->motion[kMotionTrust].row(y) + x;
    for (int i = 0; i < count; ++i) {
      const bool by_effect = effect[i].any();
      own.taps[i] = by_effect ? effect[i] : surface[i];
      own.trust[i] = by_effect ? trust[i] : 1.0f;
      own.effect[i] = by_effect ? 1.0f : 0.0f;
    }
    lanes.taps = own.taps;
    lanes.trust = own.trust;
    lanes.effect = own.effect;
  }
  if (sources.antilag) {
    if (lanes.trust == nullptr) std::fill_n(own.trust, count, 1.0f);
    for (int i = 0; i < count; ++i)
      own.trust[i] *= 1.0f - sources.antilag.at((x + i) / kStratum, y / kStratum);
    lanes.trust = own.trust;
  }
  return lanes;
}

void record(const AccumulationBlock& block, const HistorySources& sources, Channels<float>& debug) {
  for (int i = 0; i < block.count; ++i) {
    const int x = block.x + i, y = block.y;
    const bool by_effect = block.lanes.effect != nullptr && block.lanes.effect[i] > 0.0f;
    const bool valid = block.lanes.taps[i].any();
    const Channels<float>* motion =
        by_effect ? &sources.effect->motion : (valid ? &sources.surface->motion : nullptr);
    debug[kDebugX].at(x, y) = motion != nullptr ? (*motion)[0].at(x, y) : 0.0f;
    debug[kDebugY].at(x, y) = motion != nullptr ? (*motion)[1].at(x, y) : 0.0f;
    debug[kDebugFrames].at(x, y) = block.history_samples[i];
    debug[kDebugTrust].at(x, y) = block.history_weight[i];
  }
}

}  // namespace

void accumulate(const Guides& guides, const Channels<float>& noisy, const HistorySources& sources,
                const AccumulationRule& rule, const ComponentHistory& before, ComponentHistory& now,
                Channels<float>* debug) {
  accumulate(guides, noisy, sources, rule, before, now, now.data, debug);
}

void accumulate(const Guides& guides, const Channels<float>& noisy, const HistorySources& sources,
                const AccumulationRule& rule, const ComponentHistory& before, ComponentHistory& now,
                Channels<float>& signal, Channels<float>* debug) {
  const int width = guides.view.width;
  for_each_row(guides.view.height, [&](int y) {
    Choice own;
    float samples[kTapBlock], weight[kTapBlock];
    for (int x = 0; x < width; x += kTapBlock) {
      const int count = std::min(kTapBlock, width - x);
      const AccumulationLanes lanes = choose(sources, rule.rectification, x, y, count, own);
      const AccumulationBlock block{guides, noisy, before, rule,   lanes,   x,
                                    y,      count, now,    signal, samples, weight};
      accumulate_block(block);
      if (debug != nullptr) record(block, sources, *debug);
    }
  });
}

}  // namespace holdfast
