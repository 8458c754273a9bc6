#pragma once

#include <glm/glm.hpp>

namespace holdfast::scenes {

/// A rectangle as a point sees it, for samples that are uniform in solid angle (Urena, Fajardo and
/// King, "An Area-Preserving Parametrization for Spherical Rectangles", EGSR 2013).
class SphericalRectangle {
 public:
  /// The rectangle [x0, x1] x [y0, y1] in the plane at distance `height` > 0 of the point, which is
  /// the origin. Metres.
  SphericalRectangle(double x0, double x1, double y0, double y1, double height);

  /// In steradians, 0..2 pi.
  double solid_angle() const { return solid_angle_; }
  /// The point of the rectangle, in its plane, whose direction belongs to `u` in [0,1]^2.
  glm::dvec2 at(const glm::dvec2& u) const;

 private:
  double x0_, x1_, y0_, y1_, height_;
  double b0_, b1_, k_, solid_angle_;  // as the paper names them
};

}  // namespace holdfast::scenes
