#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/glm.hpp>

/// Incident radiance over a hemisphere as six cones, one upright and five around it: the set of
/// Crassin et al., "Interactive indirect illumination using voxel cone tracing", CGF 30(7), 2011
/// (VCT). Directions are of unit length, angles in radians, solid angles in steradians.
namespace holdfast {

inline constexpr int kCones = 6;
inline constexpr double kConeHalfAngle = std::numbers::pi / 6;  // VCT

/// How incident radiance is kept while it is filtered: a knob of cost.
enum class RadianceBasis {
  kIrradiance,      ///< irradiance over pi, R, G, B
  kConesLuminance,  ///< the luminance of six cones, and one chroma
  kConesColour,     ///< R, G, B of six cones
};

/// Axis of cone k, 0..5, in a frame whose Y points up: 0 is upright, the others lie 60 degrees
/// from it and 72 degrees of azimuth apart (VCT), from +Z on.
template <class T>
glm::vec<3, T> cone_axis(int k) {
  constexpr T kWideX = T(0.823639), kWideZ = T(0.267617), kBackX = T(0.509037),
              kBackZ = T(-0.700629);
  switch (k) {
    case 0: return {T(0), T(1), T(0)};
    case 1: return {T(0), T(0.5), T(0.866025)};
    case 2: return {kWideX, T(0.5), kWideZ};
    case 3: return {kBackX, T(0.5), kBackZ};
    case 4: return {-kBackX, T(0.5), kBackZ};
    default: return {-kWideX, T(0.5), kWideZ};
  }
}

/// Share of cosine-distributed directions whose nearest axis is the upright one. Where t is the
/// tangent of the polar angle and phi the azimuth to the nearest outer axis, that cell ends at
/// t cos phi = 1 / sqrt 3, which integrates to 5 / (2 pi) atan(tan(36 deg) / 2) (ours).
inline constexpr double kUprightWeight = 0.27728651033175;

/// Share of cosine-distributed directions that are nearest to the axis of cone k, and so its weight
/// in the irradiance: irradiance / pi = sum of weight times mean radiance. VCT's rounded 0.25 and
/// 0.15 are biased with samples that are told apart this way.
template <class T>
constexpr T cone_weight(int k) {
  return T(k == 0 ? kUprightWeight : (1 - kUprightWeight) / 5);
}

/// Axes of the cones for one direction that is up.
template <class T>
struct ConeAxes {
  glm::vec<3, T> of[kCones];
  ConeAxes() {
    const glm::vec<3, T> up = glm::normalize(glm::vec<3, T>(T(3), T(4), T(5)));
    const glm::vec<3, T> x = glm::normalize(glm::vec<3, T>(T(4), T(-3), T(0)));
    const glm::mat<3, 3, T> world(x, up, glm::cross(x, up));
    for (int k = 0; k < kCones; ++k) of[k] = world * cone_axis<T>(k);
  }
};
/// Those of a surface whose normal is the pole of ConeFrame, of[0].
template <class T>
inline const ConeAxes<T> kPoleAxes;

/// The rotation by the shortest arc from a pole to a normal. A frame that is a continuous function
/// of the normal has to fail somewhere: this one at minus the pole alone, which lies far from the
/// axes of the world, where floors, walls and ceilings have their normals. (The frame of Duff et
/// al., "Building an orthonormal basis, revisited", JCGT 6(1), 2017, jumps at a whole great circle,
/// normals with z = 0.)
template <class T>
class ConeFrame {
 public:
  /// `normal`: unit length. Within 1e-4 of minus the pole all axes are reversed.
  explicit ConeFrame(const glm::vec<3, T>& normal)
      : axis_(glm::cross(kPoleAxes<T>.of[0], normal)),
        cosine_(glm::dot(kPoleAxes<T>.of[0], normal)) {
    const T sine2 = glm::dot(axis_, axis_);
    if (cosine_ >= T(0)) {
      scale_ = T(1) / (T(1) + cosine_);
    } else if (sine2 > T(1e-8)) {
      scale_ = (T(1) - cosine_) / sine2;  // the same, without the difference of near equals
    } else {
      axis_ = glm::vec<3, T>(T(0));
      cosine_ = T(-1);
      scale_ = T(0);
    }
  }

  /// World-space axis of cone k.
  glm::vec<3, T> axis(int k) const { return turn(kPoleAxes<T>.of[k], axis_); }

  /// The cone whose axis is nearest to `direction`, unit length.
  int nearest(const glm::vec<3, T>& direction) const {
    const glm::vec<3, T> resting = turn(direction, -axis_);
    int best = 0;
    T most = glm::dot(resting, kPoleAxes<T>.of[0]);
    for (int k = 1; k < kCones; ++k) {
      const T cosine = glm::dot(resting, kPoleAxes<T>.of[k]);
      if (cosine > most) {
        most = cosine;
        best = k;
      }
    }
    return best;
  }

 private:
  /// Rodrigues' rotation about `about`, whose length is the sine of the angle.
  glm::vec<3, T> turn(const glm::vec<3, T>& v, const glm::vec<3, T>& about) const {
    return cosine_ * v + glm::cross(about, v) + about * (glm::dot(about, v) * scale_);
  }
  glm::vec<3, T> axis_;  ///< sine of the angle times the axis of rotation
  T cosine_, scale_;     ///< of the angle; 1 / (1 + cosine_)
};

/// Solid angle that two cones of half-angle `r` share whose axes are `d` apart, 0 <= d, r < pi/2:
///   d >= 2r: 0;   d = 0: 2 pi (1 - cos r);   else
///   2 (pi - acos((cos d - cos^2 r) / sin^2 r) - 2 cos r acos((cos r - cos d cos r) / (sin d sin
///   r)))
template <class T>
T cone_overlap(T d, T r) {
  const T cr = std::cos(r), sr = std::sin(r), cd = std::cos(d), sd = std::sin(d);
  if (d >= T(2) * r) return T(0);
  const T inside = [](T v) {
    return std::min(std::max(v, T(-1)), T(1));
  }((cd - cr * cr) / (sr * sr));
  const T wedge = sd > T(0) ? std::min((cr - cd * cr) / (sd * sr), T(1)) : T(0);
  return T(2) * (std::numbers::pi_v<T> - std::acos(inside) - T(2) * cr * std::acos(wedge));
}

/// `cone_overlap` of cones of half-angle kConeHalfAngle, from a table over d; `cosine` of d, -1..1.
float tabulated_cone_overlap(float cosine);

/// How cones of one frame turn into those of another: to[k] of from[j] is the share of cone j that
/// goes to cone k, in proportion to the solid angle that both share. Shares of a cone sum to 1, so
/// that sums of samples are kept, or to 0 where it meets no cone.
struct ConeMix {
  float share[kCones][kCones];  ///< [k][j]

  ConeMix(const ConeFrame<float>& from, const ConeFrame<float>& to);
};

/// Frames of normals this close agree: cones change by less than a few percent. One degree.
inline constexpr float kSameConesCosine = 0.99985f;

}  // namespace holdfast
