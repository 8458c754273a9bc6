#pragma once

#include <glm/glm.hpp>

namespace holdfast {

/// A specular lobe seen from one direction, as a linearly transformed cosine (Heitz, Dupuy, Hill,
/// Neubelt, SIGGRAPH 2016). In the tangent frame with the normal along +Z and the view direction
/// in the half plane y = 0, x >= 0, the lobe (BRDF times cosine, Fresnel's term left out) is about
///   magnitude / above_horizon * cos(l') / pi * d(omega')/d(omega),   l' = cosine_from_lobe l
/// for l.z > 0 and 0 below.
template <class T>
struct LtcLobe {
  glm::mat<3, 3, T> cosine_from_lobe{1};  ///< up to a positive factor; diffuse: the identity
  T above_horizon = 1;  ///< share of the transformed cosine that lies above the surface, 1/2..1
  T magnitude = 1;      ///< integral of BRDF * cosine for F = 1, 0..1: what a white furnace returns
  T fresnel = 0;        ///< the same integral weighted by (1 - h.v)^5; <= magnitude
};

/// The lobe of GGX with Smith's height-correlated shadowing (core/shading/ggx.h).
/// `roughness`: perceptual, GGX alpha = roughness^2, clamped to 0..1, NaN counts as 0.
/// `cos_view`: cosine between normal and direction to the viewer, clamped to 0..1, NaN counts as 0.
/// Bilinear in (roughness, sqrt(1 - cos_view)) over a fitted table; the mirror direction and the
/// lobe's width are exact factors of the matrix, so that smooth lobes stay where they belong
/// (ours). For T = float and double.
template <class T>
LtcLobe<T> ltc_lobe(T roughness, T cos_view);

/// Directional albedo per channel of a lobe with Schlick's Fresnel term,
///   F = f0 + (1 - f0)(1 - h.v)^5:   f0 (magnitude - fresnel) + fresnel.
/// `f0` in 0..1. The contract's plane `specular` holds such a value.
template <class T>
glm::vec<3, T> directional_albedo(const LtcLobe<T>& lobe, const glm::vec<3, T>& f0) {
  return f0 * (lobe.magnitude - lobe.fresnel) + lobe.fresnel;
}

}  // namespace holdfast
