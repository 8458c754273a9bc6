#pragma once

#include "core/history/glossy_history.h"
#include "core/oracle/frame_view.h"

namespace holdfast::oracle {

/// The planes that say what a reflection shows.
struct ReflectionInput {
  const Plane& direction;     ///< of the sampled ray, any length; (0,0,0) = no sample
  const Plane& distance;      ///< metres to the hit, +inf = sky
  const Plane* id = nullptr;  ///< instance hit; null: what is hit is static
};

/// How far each pixel's reflection is blurred by its lobe: channels of core/motion/effect_field.h.
Image lobe_field(const Surfaces& now, const ReflectionInput& input);

/// history/glossy_history.h: where each pixel's reflection was.
Past reflection_past(const FrameView& frame, const ReflectionInput& input, GlossyRule rule,
                     const FrameKey& key);

}  // namespace holdfast::oracle
