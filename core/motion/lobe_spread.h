#pragma once

#include <limits>

#include "core/motion/glossy_motion.h"
#include "core/motion/plain_math.h"

namespace holdfast {

/// How far a lobe spreads what it reflects, on the screen: standard deviations along the plane of
/// incidence and across it, pixels, and the unit vector of that plane.
struct LobeSpread {
  float in_plane, out_of_plane;
  float along_x, along_y;
};

/// `glossy_spread` and `incidence_axis` of glossy_motion.h for kernels: of the surface point `s`
/// (relative to the camera, metres) with normal `n`, as `camera` sees it.
HOLDFAST_INLINE LobeSpread lobe_spread(const Projection& camera, float focal_px, const Float3& s,
                                       const Float3& n, float hit_m, float roughness) {
  constexpr float kMost = std::numeric_limits<float>::max();
  LobeSpread spread;
  const float view_m = __builtin_sqrtf(dot(s, s));
  const float finite_share = hit_m / (view_m + hit_m);
  const float share = hit_m <= kMost ? finite_share : 1.0f;
  const float scale = 1.41421356f * focal_px, alpha = roughness * roughness;
  spread.in_plane = min_of(scale * alpha * max_of(share, 0.0f), kWidestGlossySpreadPx);
  spread.out_of_plane = spread.in_plane * abs_of(dot(s, n)) / max_of(view_m, 1e-20f);
  const float step = 1e-3f * view_m;
  float foot_x, foot_y, foot_found, tip_x, tip_y, tip_found;
  project_to(camera, s, true, foot_x, foot_y, foot_found);
  project_to(camera, {s.x + step * n.x, s.y + step * n.y, s.z + step * n.z}, true, tip_x, tip_y,
             tip_found);
  const float ax = tip_x - foot_x, ay = tip_y - foot_y;
  const float length = __builtin_sqrtf(ax * ax + ay * ay) * foot_found * tip_found;
  const float inverse = 1.0f / (length > 1e-6f ? length : 1.0f);
  spread.along_x = length > 1e-6f ? ax * inverse : 1.0f;
  spread.along_y = length > 1e-6f ? ay * inverse : 0.0f;
  return spread;
}

}  // namespace holdfast
