#pragma once

#include "core/oracle/scene.h"
#include "core/oracle/taps.h"

namespace holdfast::oracle {

/// A frame and the one before it, as every stage sees them.
struct FrameView {
  const Surfaces& now;
  const Surfaces& previous;
  const Scene& scene;
  const Past* surface = nullptr;  ///< where surfaces were; null: there is no frame before

  /// The receiver at (x, y) as it was one frame ago.
  Receiver receiver(int x, int y) const {
    const Motion& motion = scene.motion(now.id(x, y));
    return {motion.point_then(now.position(x, y)), motion.normal_then(now.normal_at(x, y)),
            now.id(x, y)};
  }
};

/// Where every pixel's surface was one frame ago: x' = P'(T^-1 s), or where `given_motion` (may be
/// null) says.
Past surface_past(const FrameView& frame, const Plane* given_motion);

}  // namespace holdfast::oracle
