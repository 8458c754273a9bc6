#include "core/radiance/cones.h"

#include <gtest/gtest.h>

#include "tests/core/small_world.h"

namespace holdfast {
namespace {

using test::Random;
using Vec = glm::dvec3;

Vec random_unit(Random& random) {
  for (;;) {
    const Vec v = random.in_box(1);
    if (glm::dot(v, v) > 0.01 && glm::dot(v, v) < 1) return glm::normalize(v);
  }
}

/// Cosine-distributed around `n`: a point of the unit sphere around the tip of n (Archimedes).
Vec cosine_sample(const Vec& n, Random& random) {
  const double z = random.uniform(-1, 1), phi = random.uniform(0, 2 * std::numbers::pi);
  const double r = std::sqrt(1 - z * z);
  const Vec sum = n + Vec(r * std::cos(phi), r * std::sin(phi), z);
  return glm::length(sum) > 1e-9 ? glm::normalize(sum) : n;
}

double angle(const Vec& a, const Vec& b) {
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

TEST(Cones, OverlapIsWhatRandomDirectionsSay) {
  Random random(3);
  const double r = kConeHalfAngle;
  constexpr int kSamples = 200000;
  for (const double degrees : {0.0, 1.0, 10.0, 25.0, 45.0, 58.0, 60.0, 75.0}) {
    const double d = glm::radians(degrees);
    int inside = 0;  // directions of the first cone that are also in the second
    for (int i = 0; i < kSamples; ++i) {
      const double z = random.uniform(std::cos(r), 1), phi = random.uniform(0, 2 * M_PI);
      const double s = std::sqrt(1 - z * z);
      inside += s * std::cos(phi) * std::sin(d) + z * std::cos(d) >= std::cos(r) ? 1 : 0;
    }
    const double cap = 2 * std::numbers::pi * (1 - std::cos(r));
    EXPECT_NEAR(cone_overlap(d, r), cap * inside / kSamples, 4 * cap * 0.5 / std::sqrt(kSamples))
        << degrees;
  }
  EXPECT_NEAR(cone_overlap(0.0, r), 2 * std::numbers::pi * (1 - std::cos(r)), 1e-6);
  EXPECT_EQ(cone_overlap(2 * r, r), 0.0);
}

TEST(Cones, TabulatedOverlapIsTheClosedForm) {
  for (double degrees = 0; degrees < 180; degrees += 0.37) {
    const double d = glm::radians(degrees);
    EXPECT_NEAR(tabulated_cone_overlap(static_cast<float>(std::cos(d))),
                cone_overlap(d, kConeHalfAngle), 5e-4)
        << degrees;
  }
  EXPECT_EQ(tabulated_cone_overlap(std::numeric_limits<float>::quiet_NaN()), 0.0f);
}

TEST(Cones, OfOneSurfaceDoNotOverlap) {
  for (int k = 0; k < kCones; ++k)
    for (int j = 0; j < kCones; ++j) {
      const auto a = cone_axis<double>(k), b = cone_axis<double>(j);
      EXPECT_NEAR(glm::length(a), 1.0, 1e-6);
      if (k != j) {
        EXPECT_LT(cone_overlap(angle(a, b), kConeHalfAngle), 1e-6) << k << " " << j;
      }
    }
}

TEST(Cones, WeightsAreTheirSharesOfCosineDistributedDirections) {
  Random random(5);
  constexpr int kSamples = 400000;
  const Vec normal = glm::normalize(Vec(0.3, -0.8, 0.2));
  const ConeFrame<double> frame(normal);
  double count[kCones] = {}, sum = 0;
  for (int i = 0; i < kSamples; ++i) count[frame.nearest(cosine_sample(normal, random))] += 1;
  for (int k = 0; k < kCones; ++k) {
    EXPECT_NEAR(cone_weight<double>(k), count[k] / kSamples, 4 * 0.45 / std::sqrt(kSamples)) << k;
    sum += cone_weight<double>(k);
  }
  EXPECT_NEAR(sum, 1.0, 1e-12);
  EXPECT_NEAR(kUprightWeight, 2.5 / std::numbers::pi * std::atan(std::tan(glm::radians(36.0)) / 2),
              1e-12);
}

TEST(ConeFrame, TurnsItsAxesWithTheNormal) {
  Random random(7);
  for (int i = 0; i < 200; ++i) {
    const Vec normal = random_unit(random);
    const ConeFrame<double> frame(normal);
    EXPECT_LT(glm::length(frame.axis(0) - normal), 1e-9);
    for (int k = 0; k < kCones; ++k) {
      EXPECT_EQ(frame.nearest(frame.axis(k)), k);
      for (int j = 0; j < kCones; ++j)
        EXPECT_NEAR(glm::dot(frame.axis(k), frame.axis(j)),
                    glm::dot(cone_axis<double>(k), cone_axis<double>(j)), 1e-9);
    }
  }
}

/// How far the frame's axes turn, at most, where the normal turns by a small angle; times that.
double turning(const Vec& normal, Random& random) {
  const double step = 1e-4;
  const Vec other = glm::normalize(normal + step * glm::cross(normal, random_unit(random)));
  double most = 0;
  for (int k = 0; k < kCones; ++k)
    most =
        std::max(most, angle(ConeFrame<double>(normal).axis(k), ConeFrame<double>(other).axis(k)));
  return most / step;
}

// The shortest arc spins by tan(a/2) for each unit that the normal moves across it, a being the
// angle to the pole: at most 19 within 6 degrees of the opposite.
TEST(ConeFrame, IsAContinuousFunctionOfTheNormal) {
  Random random(11);
  const Vec pole = glm::normalize(Vec(3, 4, 5));
  for (int i = 0; i < 3000; ++i) {
    const Vec normal = random_unit(random);
    const double half = angle(normal, pole) / 2;
    EXPECT_LT(turning(normal, random), 1.01 * (1 + std::tan(half)) + 1e-3) << half;
  }
  for (int axis = 0; axis < 3; ++axis)
    for (const double sign : {-1.0, 1.0}) {
      Vec normal(0);
      normal[axis] = sign;
      EXPECT_LT(turning(normal, random), 4.0) << "of a surface along the axes";
    }
}

TEST(ConeFrame, HasAFrameOppositeItsPoleToo) {
  const Vec opposite = -glm::normalize(Vec(3, 4, 5));
  const ConeFrame<double> frame(opposite);
  EXPECT_LT(glm::length(frame.axis(0) - opposite), 1e-9);
  for (int k = 0; k < kCones; ++k) EXPECT_EQ(frame.nearest(frame.axis(k)), k);
  const ConeFrame<float> rounded{glm::vec3(opposite)};
  for (int k = 0; k < kCones; ++k) EXPECT_NEAR(glm::length(rounded.axis(k)), 1.0f, 1e-3f);
}

TEST(ConeMix, IsTheIdentityBetweenFramesThatAgree) {
  const ConeFrame<float> frame(glm::normalize(glm::vec3(1, 2, -1)));
  const ConeMix mix(frame, frame);
  for (int k = 0; k < kCones; ++k)
    for (int j = 0; j < kCones; ++j) EXPECT_NEAR(mix.share[k][j], k == j ? 1.0f : 0.0f, 1e-3f);
}

TEST(ConeMix, KeepsTheSumOfWhatItTurns) {
  Random random(13);
  for (int i = 0; i < 500; ++i) {
    const Vec from = random_unit(random);
    const Vec to = glm::normalize(from + 0.45 * random_unit(random));
    const ConeMix mix{ConeFrame<float>(glm::vec3(from)), ConeFrame<float>(glm::vec3(to))};
    for (int j = 0; j < kCones; ++j) {
      float sum = 0;
      for (int k = 0; k < kCones; ++k) {
        EXPECT_GE(mix.share[k][j], 0.0f);
        sum += mix.share[k][j];
      }
      EXPECT_NEAR(sum, 1.0f, 1e-5f) << "cone " << j << " at " << angle(from, to);
    }
  }
}

/// Mean radiance by cone, weighted: irradiance over pi, of a smooth sky.
double by_cones(const Vec& normal, double (*sky)(const Vec&), Random& random) {
  constexpr int kSamples = 60000;
  const ConeFrame<double> frame(normal);
  double sum[kCones] = {}, count[kCones] = {}, irradiance = 0;
  for (int i = 0; i < kSamples; ++i) {
    const Vec direction = cosine_sample(normal, random);
    const int k = frame.nearest(direction);
    sum[k] += sky(direction);
    count[k] += 1;
  }
  for (int k = 0; k < kCones; ++k) irradiance += cone_weight<double>(k) * sum[k] / count[k];
  return irradiance;
}

TEST(Cones, OfConstantRadianceGiveItExactly) {
  Random random(17);
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(by_cones(
                    random_unit(random), [](const Vec&) { return 0.7; }, random),
                0.7, 1e-9);
}

// A sky of 1 + y has irradiance / pi = 1 + 2/3 n.y, whatever the frame's azimuth.
TEST(Cones, GiveTheIrradianceOfAnySurface) {
  Random random(19);
  for (int i = 0; i < 12; ++i) {
    const Vec normal = random_unit(random);
    EXPECT_NEAR(by_cones(
                    normal, [](const Vec& d) { return 1 + d.y; }, random),
                1 + 2.0 / 3 * normal.y, 0.008);
  }
}

}  // namespace
}  // namespace holdfast
