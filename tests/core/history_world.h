#pragma once

#include "core/history/component_history.h"
#include "tests/core/small_world.h"

namespace holdfast::test {

/// A still wall with the history of one component: taps lead to the pixel itself.
struct StillHistory {
  int width, height;
  Guides guides;
  SurfaceHistory surface;
  EffectHistory shadow;
  Channels<float> noisy;
  ComponentHistory before, now;

  StillHistory(int w, int h, int channels, HistoryExtras extras = HistoryExtras::kNone)
      : width(w),
        height(h),
        guides(wall(orthographic_camera(w, h), w, h)),
        surface(w, h),
        shadow(w, h),
        noisy(w, h, channels),
        before(w, h, channels, extras),
        now(w, h, channels, extras) {
    for (int y = 0; y < h; ++y)
      for (int x = 0; x < w; ++x) surface.taps[0].at(x, y) = identity_taps(guides, x, y);
    fill(before.samples(), 1.0f);
  }
  void follow_shadow(int x, int y, int from_x, int from_y, float trust = 1.0f) {
    shadow.taps[0].at(x, y) = identity_taps(guides, from_x, from_y);
    shadow.motion[0].at(x, y) = static_cast<float>(from_x - x);
    shadow.motion[1].at(x, y) = static_cast<float>(from_y - y);
    shadow.motion[2].at(x, y) = trust;
  }
  HistorySources by_surface() const { return {&surface, nullptr}; }
  HistorySources by_effect() const { return {&surface, &shadow}; }
};

}  // namespace holdfast::test
