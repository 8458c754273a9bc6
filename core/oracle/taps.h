#pragma once

#include <cstdint>
#include <vector>

#include "core/oracle/surfaces.h"

namespace holdfast::oracle {

/// Up to four pixels of the previous frame with their weights, which sum to 1; or none.
struct Taps {
  struct Tap {
    int x = 0, y = 0;
    double weight = 0;
  };
  int count = 0;
  Tap of[4];

  bool any() const { return count > 0; }
  /// The weighted value of a channel; 0 without taps.
  double read(const Image& image, int c = 0) const {
    double sum = 0;
    for (int k = 0; k < count; ++k) sum += of[k].weight * image.at(of[k].x, of[k].y, c);
    return sum;
  }
};

/// Where every pixel's surface or effect was one frame ago.
struct Past {
  int width = 0;
  std::vector<Taps> taps;
  Image motion;  ///< motion_px X, Y; 0 where nothing corresponds
  Image trust;   ///< of an effect: 0..1
  Image sweep;   ///< of shadows: how far the blocker moved before the light, in its widths

  Past(int w, int h)
      : width(w),
        taps(static_cast<std::size_t>(w) * static_cast<std::size_t>(h)),
        motion(w, h, 2),
        trust(w, h, 1),
        sweep(w, h, 1) {}
  const Taps& at(int x, int y) const { return taps[index(x, y)]; }
  Taps& at(int x, int y) { return taps[index(x, y)]; }
  void move(int x, int y, const glm::dvec2& motion_px) {
    motion.at(x, y, 0) = motion_px.x;
    motion.at(x, y, 1) = motion_px.y;
  }

 private:
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(x);
  }
};

/// What a history pixel must show to count as the same receiver one frame ago.
struct Receiver {
  glm::dvec3 point, normal;  ///< relative to the previous camera; unit
  std::uint32_t id;
};

/// history/taps.h: the 2x2 bilinear neighbourhood of previous position (x, y), each tap tested on
/// its own and renormalised; else the nearest valid tap of 3x3; else none.
Taps find_taps(const Surfaces& previous, const glm::dvec2& at, const Receiver& receiver);
Taps find_taps_on_any_surface(const Surfaces& previous, const glm::dvec2& at);
Taps find_similar_taps(const Surfaces& previous, const glm::dvec2& at, const Receiver& receiver,
                       std::uint32_t foreign_id);
inline Taps tap_at(int x, int y) { return {1, {{x, y, 1.0}}}; }

}  // namespace holdfast::oracle
