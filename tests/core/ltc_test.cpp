// The lobe table and the polygon integral, each against a formula of its own.

#include "core/shading/ltc.h"

#include <gtest/gtest.h>

#include "core/shading/polygon.h"
#include "tests/core/ltc_oracle.h"

namespace holdfast {
namespace {

using test::kInf;
using test::kNaN;

template <class T>
Polygon<T> polygon(std::initializer_list<glm::dvec3> corners) {
  Polygon<T> out;
  for (const glm::dvec3& corner : corners) out.add(glm::vec<3, T>(corner));
  return out;
}

/// Share of the cosine of a rectangle at height 1 that spans (0,0) to (a,b): textbook form factor.
double corner_share(double a, double b) {
  const double p = std::sqrt(1 + a * a), q = std::sqrt(1 + b * b);
  return (a / p * std::atan(b / p) + b / q * std::atan(a / q)) / (2 * std::numbers::pi);
}

TEST(AngleFrom, AgreesWithTheArcTangentAtAnyScale) {
  for (int i = 0; i <= 20000; ++i) {
    const double angle = std::numbers::pi * i / 20000.0;
    for (const double scale : {1e-12, 1.0, 1e12}) {
      const auto s = static_cast<float>(scale * std::sin(angle));
      const auto c = static_cast<float>(scale * std::cos(angle));
      EXPECT_NEAR(angle_from(s, c), std::atan2(double(s), double(c)), 4e-7) << angle;
    }
  }
}

TEST(CosineShare, OfARectangleIsItsFormFactor) {
  for (const double a : {0.01, 0.5, 3.0, 50.0})
    for (const double b : {0.02, 1.0, 7.0}) {
      const auto p = polygon<double>({{0, 0, 1}, {a, 0, 1}, {a, b, 1}, {0, b, 1}});
      EXPECT_NEAR(cosine_share(p), corner_share(a, b), 1e-12) << a << ' ' << b;
    }
}

TEST(CosineShare, OfAnUnboundedPlaneIsOne) {
  const auto p = polygon<float>({{-1e6, -1e6, 1}, {1e6, -1e6, 1}, {1e6, 1e6, 1}, {-1e6, 1e6, 1}});
  EXPECT_NEAR(cosine_share(p), 1.0f, 2e-6f);
}

TEST(CosineShare, OfASmallPolygonKeepsItsDigitsInFloat) {
  for (const double size : {1e-1, 1e-2, 1e-3, 1e-4}) {
    const glm::dvec3 at{0.3, -0.2, 0.7}, x{size, 0, 0.1 * size}, y{0, size, 0.3 * size};
    const std::initializer_list<glm::dvec3> corners{at, at + x, at + x + y, at + y};
    const double truth = cosine_share(polygon<double>(corners));
    EXPECT_NEAR(double(cosine_share(polygon<float>(corners))), truth, 2e-6 / size * truth) << size;
  }
}

TEST(CosineShare, IsFiniteForEveryDegeneratePolygon) {
  const glm::dvec3 o(0), x(1, 0, 0), far(3e38, 1e38, 3e38), inf(double(kInf), 0, 1);
  const glm::dvec3 nan(double(kNaN), 1, 1);
  for (const auto& corners : {std::vector{o, o, o},
                              {o, x, -x},
                              {x, x, x},
                              {x, -x, x},
                              {far, x, -far},
                              {inf, x, o},
                              {nan, x, o},
                              {inf, glm::dvec3(0, double(kInf), 1), x},
                              {glm::dvec3(1e-40), 2e-40 * x, glm::dvec3(0, 0, 1e-40)},
                              {glm::dvec3(1e-40, 0, 1e-41), glm::dvec3(-1e-40, 1e-40, 1e-41),
                               glm::dvec3(-1e-40, -1e-40, 1e-41)}}) {
    Polygon<float> p;
    for (const glm::dvec3& corner : corners) p.add(glm::vec3(corner));
    for (const float share : {cosine_share(p), cosine_share(clip_to_horizon(p))})
      EXPECT_TRUE(share >= 0.0f && share <= 1.0f) << share;
  }
}

TEST(ClipToHorizon, LeavesWhatLiesAboveAndNothingElse) {
  const auto above = polygon<double>({{0, 0, 1}, {1, 0, 1}, {0, 1, 2}});
  EXPECT_EQ(clip_to_horizon(above).count, 3u);
  EXPECT_EQ(clip_to_horizon(polygon<double>({{0, 0, -1}, {1, 0, -1}, {0, 1, -2}})).count, 0u);
  // A wall x = 1 from z = -1 to z = 3: what is left of it is the form factor of its upper part.
  const auto wall = polygon<double>({{1, -2, -1}, {1, 2, -1}, {1, 2, 3}, {1, -2, 3}});
  const auto upper = polygon<double>({{1, -2, 0}, {1, 2, 0}, {1, 2, 3}, {1, -2, 3}});
  EXPECT_EQ(clip_to_horizon(wall).count, 4u);
  EXPECT_NEAR(cosine_share(clip_to_horizon(wall)), cosine_share(upper), 1e-15);
  // One corner of a square below: five are left.
  const auto tilted = polygon<double>({{1, 0, -1}, {2, 1, 1}, {1, 2, 2}, {0, 1, 1}});
  EXPECT_EQ(clip_to_horizon(tilted).count, 5u);
}

/// The lobe's integrals by normals drawn from D itself, which the fitting program does not do.
glm::dvec2 integrals(double roughness, double cosine) {
  constexpr int kSide = 400;
  const glm::dvec3 n(0, 0, 1), v(std::sqrt(1 - cosine * cosine), 0, cosine);
  const double alpha = roughness * roughness;
  glm::dvec2 sum(0);
  for (int i = 0; i < kSide; ++i) {
    for (int j = 0; j < kSide; ++j) {
      const double u = (i + 0.5) / kSide, phi = 2 * std::numbers::pi * (j + 0.5) / kSide;
      const double tangent = alpha * std::sqrt(u / (1 - u)), z = 1 / std::hypot(1.0, tangent);
      const glm::dvec3 h(tangent * z * std::cos(phi), tangent * z * std::sin(phi), z);
      const glm::dvec3 l = glm::reflect(-v, h);
      const double hv = glm::dot(h, v);
      if (l.z <= 0 || hv <= 0) continue;
      // BRDF cos / density, density D h.z / (4 h.v).
      const double g = 1 / (1 + test::smith(l.z, alpha) + test::smith(cosine, alpha));
      const double weight = g * hv / (cosine * z);
      sum += weight * glm::dvec2(1, std::pow(1 - hv, 5)) / double(kSide * kSide);
    }
  }
  return sum;
}

TEST(LtcLobe, HoldsTheIntegralsOfTheBrdf) {
  for (const double roughness : {0.1, 0.25, 0.5, 0.77, 1.0})
    for (const double cosine : {0.2, 0.35, 0.6, 0.9, 1.0}) {
      const LtcLobe<double> lobe = ltc_lobe(roughness, cosine);
      const glm::dvec2 truth = integrals(roughness, cosine);
      EXPECT_NEAR(lobe.magnitude, truth.x, 3e-3) << roughness << ' ' << cosine;
      EXPECT_NEAR(lobe.fresnel, truth.y, 3e-3) << roughness << ' ' << cosine;
    }
}

TEST(LtcLobe, NeverReturnsMoreLightThanItGets) {
  for (int i = 0; i <= 150; ++i)
    for (int j = 0; j <= 150; ++j) {
      const auto lobe = ltc_lobe(float(i) / 150.0f, float(j) / 150.0f);
      EXPECT_TRUE(lobe.magnitude > 0.0f && lobe.magnitude <= 1.0f) << i << ' ' << j;
      EXPECT_TRUE(lobe.fresnel >= 0.0f && lobe.fresnel <= lobe.magnitude) << i << ' ' << j;
      EXPECT_TRUE(lobe.above_horizon >= 0.45f && lobe.above_horizon <= 1.0f) << i << ' ' << j;
      EXPECT_GT(glm::determinant(lobe.cosine_from_lobe), 0.0f) << i << ' ' << j;
      for (const float f0 : {0.0f, 0.04f, 1.0f}) {
        const float s = directional_albedo(lobe, glm::vec3(f0)).x;
        EXPECT_TRUE(s >= 0.0f && s <= 1.0f) << i << ' ' << j << ' ' << f0;
      }
    }
}

TEST(LtcLobe, OfASmoothSurfaceIsTheMirror) {
  for (const double cosine : {0.1, 0.4, 0.83, 1.0}) {
    const glm::dvec3 mirror(-std::sqrt(1 - cosine * cosine), 0, cosine);
    for (const double roughness : {0.0, 0.02, 0.05}) {
      const glm::dvec3 c = ltc_lobe(roughness, cosine).cosine_from_lobe * mirror;
      EXPECT_GT(c.z / glm::length(c), 0.995) << roughness << ' ' << cosine;
    }
  }
}

TEST(LtcLobe, ArgumentsOutOfRangeAreClamped) {
  const auto same = [](float r, float c, float r2, float c2) {
    const auto a = ltc_lobe(r, c), b = ltc_lobe(r2, c2);
    EXPECT_EQ(a.cosine_from_lobe, b.cosine_from_lobe);
    EXPECT_EQ(a.magnitude, b.magnitude);
  };
  same(-1.0f, 0.5f, 0.0f, 0.5f);
  same(7.0f, 0.5f, 1.0f, 0.5f);
  same(kNaN, 0.5f, 0.0f, 0.5f);
  same(0.3f, -kInf, 0.3f, 0.0f);
  same(0.3f, 2.0f, 0.3f, 1.0f);
  same(0.3f, kNaN, 0.3f, 0.0f);
}

}  // namespace
}  // namespace holdfast
