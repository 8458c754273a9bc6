#pragma once

#include "core/history/frame_pair.h"
#include "core/history/taps.h"

namespace holdfast {

/// Where every pixel's surface was one frame ago, shared by all components.
struct SurfaceHistory {
  Channels<Taps> taps;     ///< history taps along the surface motion vector
  Channels<float> motion;  ///< motion_px X and Y; 0 where nothing corresponds

  SurfaceHistory() = default;
  SurfaceHistory(int width, int height, Memory memory = Memory::kOwned)
      : taps(width, height, 1, memory), motion(width, height, 2, memory) {}
  static void each_image(auto& s, auto&& visit) {
    visit(s.taps);
    visit(s.motion);
  }
};

/// The pixel's receiver as it was one frame ago.
inline Receiver previous_receiver(const Guides& now, const ObjectMotion<float>& motion, int x,
                                  int y) {
  const glm::vec3 point(motion.carry * glm::vec4(now.position_at(x, y), 1.0f));
  return {point, glm::normalize(motion.rotate * now.normal_at(x, y)), now.id[0].at(x, y)};
}

/// Fills `out` for all pixels. `given_motion` (may be null) is the client's motion plane, pixels,
/// previous minus current; it overrides the rigid motion. Values that are not finite count as none.
///   reads guides of both frames, motion | writes taps, motion | halo 1 px in the previous frame
void trace_surface_history(const FramePair& frames, const Plane* given_motion, SurfaceHistory& out);

}  // namespace holdfast
