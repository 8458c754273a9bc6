#pragma once

#include "core/history/effect_history.h"
#include "core/history/frame_pair.h"
#include "core/motion/shadow_field.h"

namespace holdfast {

enum class ShadowRule {
  kBorrowed,  ///< the mean blocker of the neighbourhood; taps must show the same receiver
  kPaper,     ///< TRMV: a blocked sample follows its own blocker, an unblocked one the mean; any
              ///< surface on screen is taken, and the planarity falloff says how far to trust it
};

/// Fills `out` for all pixels. `valid` and `ratio` are local means of kFieldValid and
/// kFieldRatio; `own_ratio` is the pixel's own kFieldRatio (0 where it is not blocked).
///   reads guides of both frames, blocker planes | writes `out` | halo 1 px in the previous frame
void trace_shadow_history(const FramePair& frames, const ShadowTracer& tracer, ShadowRule rule,
                          ChannelView<const float> valid, ChannelView<const float> ratio,
                          ChannelView<const float> own_ratio, EffectHistory& out);

}  // namespace holdfast
