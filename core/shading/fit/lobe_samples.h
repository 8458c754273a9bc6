#pragma once

#include <vector>

#include <glm/glm.hpp>

namespace holdfast::fit {

/// A direction of a quadrature over the lobe and the share of the lobe that it stands for.
struct LobePoint {
  glm::dvec3 l{0.0};  ///< unit, tangent frame
  double weight = 0.0;
};

/// The lobe of one (alpha, view direction) as points drawn from its visible normals (Heitz, JCGT
/// 2018), one in the middle of each of side x side strata, and its two integrals. The points have y
/// > 0: the plane of incidence divides the lobe into mirror images.
struct LobeSamples {
  glm::dvec3 v{0.0};              ///< view direction, (sin, 0, cos)
  double alpha = 1.0;             ///< GGX alpha
  double magnitude = 0.0;         ///< integral of BRDF * cosine, Fresnel's term left out; 0..1
  double fresnel = 0.0;           ///< the same weighted by (1 - h.v)^5
  std::vector<LobePoint> points;  ///< weights add up to 1

  LobeSamples(double alpha, double cosine, int side);
};

}  // namespace holdfast::fit
