#pragma once

#include "core/history/frame_pair.h"
#include "core/history/taps.h"
#include "core/motion/shadow_field.h"

namespace holdfast {

/// Where every pixel's shadow of one light was one frame ago.
struct ShadowHistory {
  Channels<Taps> taps;  ///< history taps along the shadow motion vector; none without blocker
  Channels<float>
      motion;  ///< motion_px X and Y, then trust 0..1 (TRMV's falloff; 1 under kBorrowed)

  ShadowHistory() = default;
  ShadowHistory(int width, int height) : taps(width, height, 1), motion(width, height, 3) {}
};

enum class ShadowRule {
  kBorrowed,  ///< the mean blocker of the neighbourhood; taps must show the same receiver
  kPaper,     ///< TRMV: a blocked sample follows its own blocker, an unblocked one the mean; any
              ///< surface on screen is taken, and the planarity falloff says how far to trust it
};

/// Fills `out` for all pixels. `valid` and `ratio` are local means of kShadowValid and
/// kShadowRatio; `own_ratio` is the pixel's own kShadowRatio (0 where it is not blocked).
///   reads guides of both frames, blocker planes | writes `out` | halo 1 px in the previous frame
void trace_shadow_history(const FramePair& frames, const ShadowTracer& tracer, ShadowRule rule,
                          ChannelView<const float> valid, ChannelView<const float> ratio,
                          ChannelView<const float> own_ratio, ShadowHistory& out);

}  // namespace holdfast
