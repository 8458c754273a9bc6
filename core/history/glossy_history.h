#pragma once

#include <cstdint>

#include "core/history/effect_history.h"
#include "core/history/frame_pair.h"
#include "core/motion/lobe_field.h"

namespace holdfast {

/// Which pixel of the previous frame a reflection is looked for at.
enum class GlossyRule {
  kSpecular,    ///< x_C = P_{i-1}(h*_{i-1}), the virtual image of the sampled hit
  kStochastic,  ///< TRMV: a pixel of N(x_C, Sigma), the region that can reflect to the same hit
  kRelative,    ///< x_i + P_{i-1}(h*_{i-1}) - P_i(h*_i), the motion of the virtual image; ours
};

/// Key of the random choices of one frame.
struct FrameKey {
  std::uint64_t seed = 0;
  std::int64_t frame = 0;
};

/// Fills `out` for all pixels. A pixel without a sample has no taps, nor has one whose vector leads
/// off screen, behind the camera, or to another receiver (id, plane, normal, roughness within 0.1
/// where both frames have it). Nor, under kRelative, has one where camera, surface and what it
/// mirrors are at rest: its vector is the surface's. kStochastic tries its sampled pixel, then x_C.
///   reads guides of both frames, glossy planes | writes `out` | halo 1 px in the previous frame
void trace_glossy_history(const FramePair& frames, const GlossyPlanes& planes, GlossyRule rule,
                          const FrameKey& key, EffectHistory& out);

}  // namespace holdfast
