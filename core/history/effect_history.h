#pragma once

#include "core/history/taps.h"

namespace holdfast {

/// Channels of EffectHistory::motion.
enum EffectMotion { kMotionX, kMotionY, kMotionTrust, kMotionSweep, kMotionChannels };

/// Where each pixel's effect was one frame ago: the shadow of a light, a reflection, or, for a
/// surface that was hidden, what stands in for it.
struct EffectHistory {
  Channels<Taps> taps;     ///< history taps along the effect's motion vector; may be none
  Channels<float> motion;  ///< motion_px X and Y, trust 0..1 (TRMV's falloff; else 1), and of
                           ///< shadows how far the blocker moved before the light, in its widths

  EffectHistory() = default;
  EffectHistory(int width, int height, Memory memory = Memory::kOwned)
      : taps(width, height, 1, memory), motion(width, height, kMotionChannels, memory) {}
  /// Calls `visit` for all images of `s`, an EffectHistory; so do the others of this name.
  static void each_image(auto& s, auto&& visit) {
    visit(s.taps);
    visit(s.motion);
  }

  void set(int x, int y, const Taps& t, float motion_x, float motion_y, float trust) {
    taps[0].at(x, y) = t;
    motion[kMotionX].at(x, y) = motion_x;
    motion[kMotionY].at(x, y) = motion_y;
    motion[kMotionTrust].at(x, y) = trust;
  }
};

}  // namespace holdfast
