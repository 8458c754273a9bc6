#pragma once

#include "core/frame/light.h"
#include "core/oracle/frame_view.h"
#include "core/oracle/statistics.h"

namespace holdfast::oracle {

/// One light of a frame with the planes that say what blocks it.
struct ShadowInput {
  const Light& light;
  LightPlaces places;
  const Plane& distance;      ///< metres from the surface, +inf = not blocked
  const Plane& sample;        ///< (u, v) on the light
  const Plane* id = nullptr;  ///< of the blocker; null: blockers are static

  /// Whether the sample of (x, y) is blocked at a finite distance.
  bool blocked(const Surfaces& now, int x, int y) const;
  std::uint32_t blocker_id(int x, int y) const { return id != nullptr ? id->ids().at(x, y) : 0; }
  /// The light sample of (x, y): a point of light space, or a direction (w = 0).
  glm::dvec4 own_sample(int x, int y) const {
    return light_point(light, double{sample.channel(0).at(x, y)},
                       double{sample.channel(1).at(x, y)});
  }
};

/// What each pixel's blocked sample says of the shadow: channels of core/motion/effect_field.h.
Image shadow_field(const Surfaces& now, const ShadowInput& input);

/// history/shadow_history.h: where each pixel's shadow was. `paper`: a blocked sample follows its
/// own blocker, any surface is taken, and the planarity falloff says how far to trust it; else all
/// follow the mean blocker nearby, to the same receiver.
Past shadow_past(const FrameView& frame, const ShadowInput& input, bool paper, const Image& field,
                 const Statistics& statistics);

}  // namespace holdfast::oracle
