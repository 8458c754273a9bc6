#include "client/scenes/spherical_rectangle.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace holdfast::scenes {
namespace {

/// The inner angle of a spherical polygon between two planes through the origin.
double inner_angle(const glm::dvec3& n, const glm::dvec3& m) {
  return std::acos(std::clamp(-glm::dot(n, m), -1.0, 1.0));
}

}  // namespace

SphericalRectangle::SphericalRectangle(double x0, double x1, double y0, double y1, double height)
    : x0_(x0), x1_(x1), y0_(y0), y1_(y1), height_(height) {
  // Normals of the planes through the origin and each edge; z points away from the rectangle.
  const double z = -height;
  const glm::dvec3 n0 = glm::normalize(glm::dvec3(0.0, z, -y0));
  const glm::dvec3 n1 = glm::normalize(glm::dvec3(-z, 0.0, x1));
  const glm::dvec3 n2 = glm::normalize(glm::dvec3(0.0, -z, y1));
  const glm::dvec3 n3 = glm::normalize(glm::dvec3(z, 0.0, -x0));
  b0_ = n0.z;
  b1_ = n2.z;
  k_ = 2.0 * std::numbers::pi - inner_angle(n2, n3) - inner_angle(n3, n0);
  solid_angle_ = std::max(0.0, inner_angle(n0, n1) + inner_angle(n1, n2) - k_);
}

glm::dvec2 SphericalRectangle::at(const glm::dvec2& u) const {
  const double angle = u.x * solid_angle_ + k_;
  const double f = (std::cos(angle) * b0_ - b1_) / std::sin(angle);
  const double c = std::clamp(std::copysign(1.0 / std::sqrt(f * f + b0_ * b0_), f), -1.0, 1.0);
  const double x = std::clamp(c * height_ / std::sqrt(std::max(1e-300, 1.0 - c * c)), x0_, x1_);
  const double d2 = x * x + height_ * height_;
  const double h0 = y0_ / std::sqrt(d2 + y0_ * y0_), h1 = y1_ / std::sqrt(d2 + y1_ * y1_);
  const double h = h0 + u.y * (h1 - h0);
  const double y = h * std::sqrt(d2 / std::max(1e-300, 1.0 - h * h));
  return {x, std::clamp(y, y0_, y1_)};
}

}  // namespace holdfast::scenes
