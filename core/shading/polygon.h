#pragma once

#include <array>
#include <cmath>
#include <numbers>
#include <type_traits>

#include <glm/glm.hpp>

#include "core/kernels/math.h"

namespace holdfast {

/// Angle in 0..pi of a direction with this sine >= 0 and cosine, not both 0, at any scale. In
/// float: Abramowitz and Stegun 4.4.49, error below 2e-7, several times faster than std::atan2.
template <class T>
T angle_from(T sine, T cosine) {
  if constexpr (std::is_same_v<T, float>) {
    constexpr float kCoefficients[] = {0.0028662257f,  -0.0161657367f, 0.0429096138f,
                                       -0.0752896400f, 0.1065626393f,  -0.1420889944f,
                                       0.1999355085f,  -0.3333314528f, 1.0f};
    const float c = abs_of(cosine);
    const float t = min_of(sine, c) / max_of(sine, c), t2 = t * t;
    float p = 0.0f;
    for (const float k : kCoefficients) p = p * t2 + k;
    const float low = p * t, angle = sine > c ? 0.5f * std::numbers::pi_v<float> - low : low;
    return cosine < 0.0f ? std::numbers::pi_v<float> - angle : angle;
  } else {
    return std::atan2(sine, cosine);
  }
}

/// Corners of the polygon that stands for a disk or a sphere: its area is the disk's, and the
/// irradiance it sends is the disk's to about one per cent (tests/core/ltc_light_test.cpp).
inline constexpr int kDiskCorners = 16;

/// A convex polygon as seen from the origin; only directions matter for what it radiates.
template <class T>
struct Polygon {
  static constexpr std::size_t kMaxCorners = kDiskCorners + 2;  // each of two clips adds one
  std::array<glm::vec<3, T>, kMaxCorners> corners;
  std::size_t count = 0;

  void add(const glm::vec<3, T>& corner) {
    if (count < kMaxCorners) corners[count++] = corner;
  }
};

/// The part of a polygon with z >= 0; empty if nothing is left. Sutherland and Hodgman's algorithm
/// for one plane (CACM 1974): a convex polygon stays convex and gains at most one corner.
template <class T>
Polygon<T> clip_to_horizon(const Polygon<T>& polygon) {
  Polygon<T> out;
  for (std::size_t i = 0; i < polygon.count; ++i) {
    const auto &a = polygon.corners[i], &b = polygon.corners[i + 1 < polygon.count ? i + 1 : 0];
    if (a.z >= T(0)) out.add(a);
    if ((a.z >= T(0)) == (b.z >= T(0))) continue;
    auto crossing = a + (b - a) * (a.z / (a.z - b.z));
    crossing.z = T(0);
    out.add(crossing);
  }
  if (out.count < 3) out.count = 0;
  return out;
}

/// The share of a clamped cosine around +Z that a polygon above the horizon covers, 0..1:
///   1/(2 pi) |sum over edges of angle(a, b) (a x b).z / |a x b||
/// (Lambert). That is irradiance over pi for unit radiance. The polygon must be clipped; corners
/// may be at any distance. Each a x b is computed as a x (b - a), which keeps the polygon closed
/// under rounding, so that a light of angular size e has a relative error of about epsilon / e. An
/// edge through the origin counts as nothing: half of what is seen there, the limit of both sides.
/// A polygon with corners that are not finite counts as nothing.
template <class T>
T cosine_share(const Polygon<T>& polygon) {
  T largest = T(0);
  for (std::size_t i = 0; i < polygon.count; ++i)
    for (int axis = 0; axis < 3; ++axis)
      largest = max_of(largest, abs_of(polygon.corners[i][axis]));
  if (!(largest > T(0))) return T(0);
  const T scale = T(1) / largest;  // no square overflows, few underflow
  T sum = T(0);
  for (std::size_t i = 0; i < polygon.count; ++i) {
    const auto a = polygon.corners[i] * scale;
    const auto b = polygon.corners[i + 1 < polygon.count ? i + 1 : 0] * scale;
    const auto c = glm::cross(a, b - a);
    const T length = glm::length(c);
    if (length > T(0))  // false for corners that are not finite
      sum += angle_from(length, glm::dot(a, b)) * (c.z / length);
  }
  return min_of(T(1), abs_of(sum) * T(0.5 * std::numbers::inv_pi));
}

}  // namespace holdfast
