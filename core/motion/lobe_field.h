#pragma once

#include "core/frame/guides.h"
#include "core/motion/effect_field.h"

namespace holdfast {

/// The planes that say what a reflection shows.
struct GlossyPlanes {
  const Plane* direction = nullptr;  ///< of the sampled ray; (0,0,0) = no sample
  const Plane* distance = nullptr;   ///< metres to the hit, +inf = sky
  const Plane* id = nullptr;         ///< instance hit; null: what is hit is static

  explicit operator bool() const { return direction != nullptr && distance != nullptr; }
};

/// Measures how far a reflection is blurred by its lobe, into channels first.. of `out`, which are
/// those of a field: kFieldPrecision is that of the lobe's footprint in pixels (glossy_spread of
/// the sampled hit), kFieldRatio stays 0. All are 0 where nothing was sampled.
///   reads guides with roughness, glossy planes | writes `out` | halo 0
void measure_lobes(const Guides& now, const GlossyPlanes& planes, Channels<float>& out, int first);

}  // namespace holdfast
