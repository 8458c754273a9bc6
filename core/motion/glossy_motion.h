#pragma once

#include <cmath>

#include <glm/glm.hpp>

#include "core/frame/view_geometry.h"

namespace holdfast {

/// The image of a hit point in the plane of its reflector, h* = h - 2 ((h - s) . n) n, as the eye
/// sees it through the plane (Zimmer et al. 2015; Mara et al. 2017). `hit` is a point (w = 1) or,
/// for a ray that met nothing, its direction (w = 0), whose image is a direction. `normal` is unit.
template <class T>
glm::vec<4, T> virtual_image(const glm::vec<4, T>& hit, const glm::vec<3, T>& surface,
                             const glm::vec<3, T>& normal) {
  const glm::vec<3, T> from_surface = glm::vec<3, T>(hit) - hit.w * surface;
  return {glm::vec<3, T>(hit) - T(2) * glm::dot(from_surface, normal) * normal, hit.w};
}

/// Standard deviations, in pixels, of the region that can reflect to the same hit point.
template <class T>
struct GlossySpread {
  T in_plane, out_of_plane;  ///< along and across the image of the plane of incidence
};

/// Widest spread that is followed: a wider lobe is better followed by the surface. Ours.
inline constexpr float kWidestGlossySpreadPx = 16.0f;

/// sigma_in = 2 f (alpha / sqrt 2) d_h / (d_v + d_h),  sigma_out = sigma_in cos(theta_r), at most
/// kWidestGlossySpreadPx. `focal_px` is the focal length in pixels, `alpha` GGX alpha, `view_m` and
/// `hit_m` the surface's distances to the camera and the hit (may be infinite), `cosine` that of
/// the angle of incidence. 0 for a mirror or at contact. Ours; TRMV gives no closed form.
template <class T>
GlossySpread<T> glossy_spread(T focal_px, T alpha, T view_m, T hit_m, T cosine) {
  const T share = std::isfinite(hit_m) ? hit_m / (view_m + hit_m) : T(1);
  const T widest = T(kWidestGlossySpreadPx);
  const T in_plane = T(std::sqrt(T(2))) * focal_px * alpha * (share > T(0) ? share : T(0));
  const T clipped = in_plane < widest ? in_plane : widest;
  return {clipped, clipped * cosine};
}

/// The image of a pixel's plane of incidence: the direction, in pixels and of unit length, in which
/// the normal of its surface appears. Any direction where the normal points at the camera.
template <class T>
glm::vec<2, T> incidence_axis(const glm::mat<4, 4, T>& pixel_from_relative,
                              const glm::vec<3, T>& surface, const glm::vec<3, T>& normal) {
  const auto foot = project(pixel_from_relative, surface);
  const auto tip = project(pixel_from_relative, surface + T(1e-3) * glm::length(surface) * normal);
  const glm::vec<2, T> along(tip.x - foot.x, tip.y - foot.y);
  const T length = glm::length(along);
  const bool usable = foot.in_front && tip.in_front && length > T(1e-6);
  return usable ? along / length : glm::vec<2, T>(1, 0);
}

}  // namespace holdfast
