#pragma once

#include <glm/glm.hpp>

#include "core/frame/light.h"

namespace holdfast {

/// A light where it stands in one frame, ready to be evaluated at many points. Any frame of
/// reference in metres that is also the points': the world, or relative to the camera.
template <class T>
struct PlacedLight {
  LightShape shape = LightShape::kPoint;
  bool is_delta = true;                 ///< a single direction: point, or sun of less than 1e-4 rad
  glm::vec<3, T> centre{0};             ///< metres; directional: unit direction towards the light
  glm::vec<3, T> half_x{0}, half_y{0};  ///< half axes of rectangle, disk and sun
  glm::vec<3, T> forward{0};            ///< unit; rectangle and disk emit on this side only
  T radius = 0;                         ///< sphere, metres
  glm::vec<3, T> emission{0};  ///< point: W/sr; sun without extent: W/m^2; others: W/(m^2 sr)
};

/// Places `light` by its rigid `frame_from_light`; `Light::radiance` says what it emits. The
/// radiance of a sun with extent is its irradiance over its solid angle.
template <class T>
PlacedLight<T> place_light(const Light& light, const glm::dmat4& frame_from_light);

/// A point to be lit.
template <class T>
struct ShadingPoint {
  glm::vec<3, T> position{0};   ///< metres, in the light's frame of reference
  glm::vec<3, T> normal{0};     ///< unit, faces the viewer
  glm::vec<3, T> to_viewer{0};  ///< unit
  glm::vec<3, T> albedo{0};     ///< diffuse
  glm::vec<3, T> specular{0};   ///< directional albedo of the lobe (`directional_albedo`)
  T roughness = 1;              ///< perceptual, 0..1
};

/// Radiance towards the viewer of the direct light of one light as if nothing blocked it:
///   emission * (albedo * D + specular * S)
/// D is the light's share of the clamped cosine, in closed form; S its share of the lobe, by
/// linearly transformed cosines (core/shading/ltc.h). Only the light above the surface's horizon
/// counts. Rectangles are exact polygons; disks, suns, and spheres (the disk that covers the same
/// directions) are regular polygons of kDiskCorners corners and the same area. Points and suns
/// without extent need no integral: D = cosine / pi, S = BRDF * cosine / magnitude.
///
/// Fresnel's term is the lobe's mean, which `specular` contains. 0 behind a one-sided light, inside
/// a sphere, for an extended light of size zero, and where the light stands no more than 1e-4 rad
/// above the surface, as in its plane; everywhere else D and S are more than 0, so that rounding
/// does not decide what is lit. Finite for finite input, except that a point light within 1e-6 m
/// counts as that far away. For T = float and double.
/// Heitz et al., SIGGRAPH 2016; ours: what the transform puts below the horizon is cut off first,
/// and the rest divided by its share, so that a white furnace returns `specular` exactly.
template <class T>
glm::vec<3, T> unshadowed_light(const PlacedLight<T>& light, const ShadingPoint<T>& point);

}  // namespace holdfast
