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

bool has_effect(const HistorySources& sources, int x, int y) {
  return sources.effect != nullptr && sources.effect->taps[0].at(x, y).any();
}

/// Chooses what the pixels from (x, y) on follow.
void choose(const HistorySources& sources, Rectification rectification, int x, int y, int count,
            AccumulationLanes& lanes) {
  const Taps none[kTapBlock] = {};
  const Taps* surface = sources.surface != nullptr ? sources.surface->taps[0].row(y) + x : none;
  const Taps* effect = sources.effect != nullptr ? sources.effect->taps[0].row(y) + x : none;
  const float* trust =
      sources.effect != nullptr ? sources.effect->motion[kMotionTrust].row(y) + x : nullptr;
  const float clamped[2] = {clamps(rectification, false) ? 1.0f : 0.0f,
                            clamps(rectification, true) ? 1.0f : 0.0f};
  float any_clamped = 0;
  for (int i = 0; i < count; ++i) {
    const bool by_effect = effect[i].any(), valid = by_effect || surface[i].any();
    lanes.taps[i] = by_effect ? effect[i] : surface[i];
    lanes.trust[i] = by_effect ? trust[i] : (valid ? 1.0f : 0.0f);
    lanes.clamped[i] = valid ? clamped[by_effect ? 1 : 0] : 0.0f;
    any_clamped += lanes.clamped[i];
  }
  lanes.any_clamped = any_clamped > 0.0f;
  if (sources.antilag)
    for (int i = 0; i < count; ++i)
      lanes.trust[i] *= 1.0f - sources.antilag.at((x + i) / kStratum, y / kStratum);
}

void record(const AccumulationBlock& block, const HistorySources& sources, Channels<float>& debug) {
  for (int i = 0; i < block.count; ++i) {
    const int x = block.x + i, y = block.y;
    const bool by_effect = has_effect(sources, x, y), valid = block.lanes.taps[i].any();
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
  const int width = guides.view.width;
  for_each_row(guides.view.height, [&](int y) {
    AccumulationLanes lanes;
    float samples[kTapBlock], weight[kTapBlock];
    for (int x = 0; x < width; x += kTapBlock) {
      const int count = std::min(kTapBlock, width - x);
      choose(sources, rule.rectification, x, y, count, lanes);
      const AccumulationBlock block{guides, noisy, before, rule,    lanes, x,
                                    y,      count, now,    samples, weight};
      accumulate_block(block);
      if (debug != nullptr) record(block, sources, *debug);
    }
  });
}

}  // namespace holdfast
