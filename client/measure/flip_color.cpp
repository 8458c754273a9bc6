#include "client/measure/flip_color.h"

#include <bit>
#include <cmath>
#include <cstdint>

namespace holdfast::measure {
namespace {

// Linear sRGB to XYZ for D65 as fractions, and its inverse; Andersson et al. 2020, supplement.
constexpr float kXyzFromRgb[3][3] = {
    {10135552.0f / 24577794.0f, 8788810.0f / 24577794.0f, 4435075.0f / 24577794.0f},
    {2613072.0f / 12288897.0f, 8788810.0f / 12288897.0f, 887015.0f / 12288897.0f},
    {1425312.0f / 73733382.0f, 8788810.0f / 73733382.0f, 70074185.0f / 73733382.0f}};
constexpr float kRgbFromXyz[3][3] = {{3.241003275f, -1.537398934f, -0.498615861f},
                                     {-0.969224334f, 1.875930071f, 0.041554224f},
                                     {0.055639423f, -0.204011202f, 1.057148933f}};
constexpr Color kWhite{0.950428545f, 1.0f, 1.088900371f};  // XYZ of (1,1,1)

constexpr float kColorPower = 0.7f;     // q_c
constexpr float kKneeOfMaximum = 0.4f;  // p_c
constexpr float kErrorAtKnee = 0.95f;   // p_t

Color transform(const float (&m)[3][3], Color c) {
  return {m[0][0] * c.x + m[0][1] * c.y + m[0][2] * c.z,
          m[1][0] * c.x + m[1][1] * c.y + m[1][2] * c.z,
          m[2][0] * c.x + m[2][1] * c.y + m[2][2] * c.z};
}

/// Cube root of x > 0 to a relative error below 3e-7: an estimate from the exponent, then two steps
/// of Halley's method. Unlike std::cbrt it vectorises.
float cube_root(float x) {
  const std::uint32_t bits = std::bit_cast<std::uint32_t>(x) / 3 + 709921077u;  // Kahan
  float y = std::bit_cast<float>(bits);
  for (int i = 0; i < 2; ++i) {
    const float cube = y * y * y;
    y *= (cube + 2 * x) / (2 * cube + x);
  }
  return y;
}

/// The cube root of CIE L*a*b* with its linear toe.
float lab_curve(float value) {
  constexpr float kDelta = 6.0f / 29.0f;
  return value > kDelta * kDelta * kDelta ? cube_root(value)
                                          : value / (3 * kDelta * kDelta) + 4.0f / 29.0f;
}

float largest_distance() {
  static const float distance =
      hyab_distance(hunt_lab_from_linear_rgb({0, 1, 0}), hunt_lab_from_linear_rgb({0, 0, 1}));
  return distance;
}

}  // namespace

Color ycxcz_from_linear_rgb(Color rgb) {
  const Color xyz = transform(kXyzFromRgb, rgb);
  const float x = xyz.x / kWhite.x, y = xyz.y, z = xyz.z / kWhite.z;
  return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

Color linear_rgb_from_ycxcz(Color c) {
  const float y = (c.x + 16) / 116;
  return transform(kRgbFromXyz,
                   {(y + c.y / 500) * kWhite.x, y * kWhite.y, (y - c.z / 200) * kWhite.z});
}

Color hunt_lab_from_linear_rgb(Color rgb) {
  const Color xyz = transform(kXyzFromRgb, rgb);
  const float x = lab_curve(xyz.x / kWhite.x), y = lab_curve(xyz.y),
              z = lab_curve(xyz.z / kWhite.z);
  const float lightness = 116 * y - 16;
  return {lightness, 0.01f * lightness * 500 * (x - y), 0.01f * lightness * 200 * (y - z)};
}

float lightness_of_grey(float grey) { return 116 * lab_curve(grey) - 16; }

float hyab_distance(Color a, Color b) {
  return std::abs(a.x - b.x) + std::sqrt((a.y - b.y) * (a.y - b.y) + (a.z - b.z) * (a.z - b.z));
}

float redistributed_color_error(float hyab) {
  static const float largest = std::pow(largest_distance(), kColorPower);
  const float error = std::pow(hyab, kColorPower);
  const float knee = kKneeOfMaximum * largest;
  if (error < knee) return error * kErrorAtKnee / knee;
  return kErrorAtKnee + (error - knee) / (largest - knee) * (1 - kErrorAtKnee);
}

}  // namespace holdfast::measure
