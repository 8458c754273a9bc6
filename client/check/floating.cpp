#include "client/check/floating.h"

#include <algorithm>
#include <cmath>

namespace holdfast::check {

bool floats(const Seen& frame, const glm::dvec3& relative_point) {
  constexpr double kClearly = 0.97;  // of the nearest depth shown
  const auto p = project(frame.view.pixel_from_relative, relative_point);
  if (!p.in_front) return false;
  const glm::dvec2 grid = glm::floor(glm::dvec2(p.x, p.y) - frame.jitter);
  if (grid.x < 1 || grid.y < 1 || grid.x >= frame.width() - 1 || grid.y >= frame.height() - 1)
    return false;
  const int x = static_cast<int>(grid.x), y = static_cast<int>(grid.y);
  for (int v = y - 1; v <= y + 1; ++v)
    for (int u = x - 1; u <= x + 1; ++u) {
      const auto shown = static_cast<double>(frame.depth_at(u, v));
      if (shown > 0 && p.depth >= kClearly * shown) return false;
    }
  return true;
}

}  // namespace holdfast::check
