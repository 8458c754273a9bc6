#pragma once

#include "core/history/frame_pair.h"
#include "core/history/taps.h"

namespace holdfast {

/// Where every pixel's surface was one frame ago, shared by all components.
struct SurfaceHistory {
  Channels<Taps> taps;     ///< history taps along the surface motion vector
  Channels<float> motion;  ///< motion_px X and Y; 0 where nothing corresponds
  /// 1 for each kBlock pixels of a row, the first at a multiple of it, that all have taps; 0 for
  /// those of which that is not known.
  Channels<std::uint8_t> complete;
  static constexpr int kBlock = 64;

  SurfaceHistory() = default;
  SurfaceHistory(int width, int height, Memory memory = Memory::kOwned)
      : taps(width, height, 1, memory),
        motion(width, height, 2, memory),
        complete((width + kBlock - 1) / kBlock, height, 1, memory) {}
  static void each_image(auto& s, auto&& visit) {
    visit(s.taps);
    visit(s.motion);
    visit(s.complete);
  }
  /// Whether all of `count` pixels from (x, y) on are known to have taps.
  bool all_have_taps(int x, int y, int count) const {
    const std::uint8_t* blocks = complete[0].row(y);
    for (int block = x / kBlock; block <= (x + count - 1) / kBlock; ++block)
      if (blocks[block] == 0) return false;
    return true;
  }
  /// Taps of `count` pixels from (x, y) on: the surface's, and where it has none those of
  /// `stand_in`. Written to `own` only if they are of both kinds.
  const Taps* taps_or(const Channels<Taps>& stand_in, int x, int y, int count, Taps* own) const {
    const Taps* first = taps[0].row(y) + x;
    if (all_have_taps(x, y, count)) return first;
    return preferred_taps(first, stand_in[0].row(y) + x, count, own);
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
///   reads guides of both frames, motion | writes `out` | halo 1 px in the previous frame
void trace_surface_history(const FramePair& frames, const Plane* given_motion, SurfaceHistory& out);

}  // namespace holdfast
