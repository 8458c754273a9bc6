#pragma once

#include <cmath>
#include <numbers>

#include <glm/glm.hpp>

#include "core/kernels/math.h"

namespace holdfast {

/// The specular lobe of every material: GGX normals, Smith's height-correlated shadowing (Heitz,
/// JCGT 2014). Directions are unit, in a tangent frame with the normal along +Z, and point away
/// from the surface.

/// Smallest GGX alpha; smoother surfaces count as this smooth, which no picture tells from a
/// mirror.
inline constexpr double kLeastAlpha = 1e-4;
/// Smallest cosine between normal and view direction.
inline constexpr double kLeastCosine = 1e-3;

/// GGX alpha of a perceptual roughness, which is clamped to 0..1. NaN counts as 0.
template <class T>
T lobe_alpha(T roughness) {
  const T r = roughness > T(0) ? min_of(roughness, T(1)) : T(0);
  return max_of(T(kLeastAlpha), r * r);
}

/// Smith's Lambda of a direction whose cosine to the normal is `cosine` > 0.
template <class T>
T smith_lambda(T cosine, T alpha) {
  const T c2 = square(cosine);
  return T(0.5) * (std::sqrt(T(1) + square(alpha) * max_of(T(0), T(1) - c2) / c2) - T(1));
}

/// D(h) G2(v, l) / (4 v.z), the BRDF towards `l` times its cosine, Fresnel's term left out. 0 for
/// l.z <= 0; requires v.z > 0.
template <class T>
T ggx_lobe(const glm::vec<3, T>& v, const glm::vec<3, T>& l, T alpha) {
  if (!(l.z > T(0))) return T(0);
  const glm::vec<3, T> h = glm::normalize(v + l);
  // (h.x^2 + h.y^2)/alpha^2 + h.z^2 keeps its digits where alpha is small.
  const T stretch = (square(h.x) + square(h.y)) / square(alpha) + square(h.z);
  const T d = T(std::numbers::inv_pi) / square(alpha * stretch);
  const T g2 = T(1) / (T(1) + smith_lambda(v.z, alpha) + smith_lambda(l.z, alpha));
  return d * g2 / (T(4) * v.z);
}

}  // namespace holdfast
