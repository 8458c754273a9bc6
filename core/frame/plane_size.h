#pragma once

#include "core/frame/plane_id.h"

namespace holdfast {

/// Width and height of a plane, pixels.
struct PlaneSize {
  int width = 0, height = 0;
  friend bool operator==(const PlaneSize&, const PlaneSize&) = default;
};

/// Edge of the square of pixels that shares one gradient sample (A-SVGF), pixels.
inline constexpr int kStratum = 3;

/// Size of a plane of `id` in a frame of `width` x `height` pixels: the frame's; for gradient
/// planes one value for each stratum, ceil(width / 3) x ceil(height / 3).
inline PlaneSize plane_size(PlaneId id, int width, int height) {
  if (id.kind != PlaneKind::kGradient) return {width, height};
  return {(width + kStratum - 1) / kStratum, (height + kStratum - 1) / kStratum};
}

/// "160x90".
inline std::string size_text(PlaneSize size) {
  return std::to_string(size.width) + "x" + std::to_string(size.height);
}

}  // namespace holdfast
