#include "core/motion/shadow_motion.h"

#include <gtest/gtest.h>

#include "tests/core/small_world.h"

namespace holdfast {
namespace {

/// A light sample that is blocked on its way to a receiver, now and one frame ago, in double.
struct Shadowing {
  glm::dvec4 light_before;
  glm::dvec3 blocker_before, surface_before, normal_before;
};

template <class T>
ShadowSample<T> sample_of(const Shadowing& s) {
  return {glm::vec<3, T>(s.surface_before), glm::vec<3, T>(s.normal_before),
          glm::vec<3, T>(s.blocker_before), glm::vec<4, T>(s.light_before)};
}

/// Light, blocker and receiver that move rigidly on their own.
Shadowing random_setup(test::Random& random, bool sun) {
  const glm::dmat4 receiver = test::random_rigid(random, 0.4, 0.5);
  const glm::dvec3 normal = glm::normalize(glm::dvec3(receiver[1]));
  const glm::dvec3 surface = glm::dvec3(receiver[3]) + random.in_box(0.1);
  glm::dvec4 light(random.uniform(-2, 2), random.uniform(3, 5), random.uniform(-2, 2), 1);
  if (sun) light = glm::dvec4(glm::normalize(glm::dvec3(light)), 0);
  // The blocker lies on the ray now.
  const glm::dvec3 to_light = glm::dvec3(light) - light.w * surface;
  const glm::dvec3 blocker = surface + random.uniform(0.3, 0.7) * (sun ? 4.0 : 1.0) * to_light;
  const auto back = [&](double angle, double distance) {
    return glm::inverse(test::random_rigid(random, angle, distance));
  };
  const glm::dmat4 receiver_back = back(0.1, 0.2), blocker_back = back(0.1, 0.2),
                   light_back = back(0.2, 0.3);
  return {light_back * light, glm::dvec3(blocker_back * glm::dvec4(blocker, 1)),
          glm::dvec3(receiver_back * glm::dvec4(surface, 1)),
          glm::normalize(glm::dmat3(receiver_back) * normal)};
}

/// Ray and plane by a linear system: from + t ray = surface + a u + b v.
glm::dvec3 shadow_by_linear_system(const Shadowing& s) {
  const glm::dvec3 ray = s.light_before.w * s.blocker_before - glm::dvec3(s.light_before);
  const glm::dvec3 u = glm::normalize(glm::cross(s.normal_before, glm::dvec3(0.3, 0.1, 0.9)));
  const glm::dvec3 v = glm::cross(s.normal_before, u);
  const glm::dvec3 tab =
      glm::inverse(glm::dmat3(ray, -u, -v)) * (s.surface_before - s.blocker_before);
  return s.blocker_before + tab.x * ray;
}

template <class T>
class ShadowVector : public testing::Test {
 public:
  /// Metres, in scenes 5 m across at moderate angles: rounding alone.
  static constexpr double kTolerance = std::is_same_v<T, float> ? 2e-5 : 1e-12;
};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(ShadowVector, Scalars);

TYPED_TEST(ShadowVector, FollowsTheShadowOfMovingLightBlockerAndReceiver) {
  for (const bool sun : {false, true}) {
    test::Random random(sun ? 11 : 12);
    for (int trial = 0; trial < 300; ++trial) {
      const Shadowing setup = random_setup(random, sun);
      glm::vec<3, TypeParam> hit;
      ASSERT_TRUE(shadow_previous_point(sample_of<TypeParam>(setup), hit)) << trial;
      EXPECT_LT(glm::distance(glm::dvec3(hit), shadow_by_linear_system(setup)), this->kTolerance);
    }
  }
}

/// A light straight above a horizontal floor at height 0 whose blocker is half way up.
template <class T>
ShadowSample<T> plain_sample() {
  return {{0, 0, 0}, {0, 1, 0}, {0, 1, 0}, {0, 2, 0, 1}};
}

TYPED_TEST(ShadowVector, FollowsTheBlockerOfAMovingLight) {
  auto sample = plain_sample<TypeParam>();
  sample.light.x = TypeParam(1);  // the light was 1 m to the right: the shadow was 1 m to the left
  glm::vec<3, TypeParam> hit;
  ASSERT_TRUE(shadow_previous_point(sample, hit));
  EXPECT_NEAR(double(hit.x), -1.0, 1e-6);
  EXPECT_NEAR(double(hit.y), 0.0, 1e-6);
}

TYPED_TEST(ShadowVector, OfAStillSceneIsTheSurfaceItself) {
  glm::vec<3, TypeParam> hit;
  ASSERT_TRUE(shadow_previous_point(plain_sample<TypeParam>(), hit));
  EXPECT_EQ(hit, (glm::vec<3, TypeParam>(0)));
}

TYPED_TEST(ShadowVector, NeedsTheBlockerBetweenLightAndReceiver) {
  using T = TypeParam;
  const glm::vec<3, T> untouched(7, 8, 9);
  const auto rejects = [&](ShadowSample<T> sample, const char* why) {
    glm::vec<3, T> hit = untouched;
    EXPECT_FALSE(shadow_previous_point(sample, hit)) << why;
    EXPECT_EQ(hit, untouched) << why;
  };
  auto sample = plain_sample<T>();
  sample.blocker.y = T(-0.5);
  rejects(sample, "blocker under the receiver");
  sample = plain_sample<T>();
  sample.blocker.y = T(3);
  rejects(sample, "blocker behind the light");
  sample = plain_sample<T>();
  sample.light = {0, -2, 0, 1};
  rejects(sample, "light under the receiver");
  sample = plain_sample<T>();
  sample.light = {5, 1, 0, 1};
  rejects(sample, "the ray runs along the receiver");
  sample = plain_sample<T>();
  sample.light = {5, T(1.0001), 0, 1};
  rejects(sample, "the ray grazes the receiver");
  sample = plain_sample<T>();
  sample.blocker = {0, 2, 0};
  rejects(sample, "blocker in the light");
  sample = plain_sample<T>();
  sample.light = {0, -1, 0, 0};
  rejects(sample, "sun under the receiver");
}

TYPED_TEST(ShadowVector, RejectsWhatIsNotFinite) {
  using T = TypeParam;
  for (const T bad : {std::numeric_limits<T>::quiet_NaN(), std::numeric_limits<T>::infinity(),
                      -std::numeric_limits<T>::infinity()})
    for (int which = 0; which < 4; ++which)
      for (int axis = 0; axis < 3; ++axis) {
        auto sample = plain_sample<T>();
        if (which == 0) sample.surface[axis] = bad;
        if (which == 1) sample.normal[axis] = bad;
        if (which == 2) sample.blocker[axis] = bad;
        if (which == 3) sample.light[axis] = bad;
        glm::vec<3, T> hit(0);
        if (shadow_previous_point(sample, hit)) {
          EXPECT_TRUE(std::isfinite(hit.x) && std::isfinite(hit.y) && std::isfinite(hit.z))
              << "input " << which << " axis " << axis << " value " << bad;
        }
      }
}

TYPED_TEST(ShadowVector, OfASunFollowsItsDirection) {
  auto sample = plain_sample<TypeParam>();
  sample.light = {TypeParam(0.6), TypeParam(0.8), 0, 0};
  glm::vec<3, TypeParam> hit;
  ASSERT_TRUE(shadow_previous_point(sample, hit));
  EXPECT_NEAR(double(hit.x), -0.75, 1e-6);
  EXPECT_NEAR(double(hit.y), 0.0, 1e-6);
}

TYPED_TEST(ShadowVector, TouchingBlockerIsItsOwnShadow) {
  auto sample = plain_sample<TypeParam>();
  sample.blocker.y = 0;
  glm::vec<3, TypeParam> hit;
  ASSERT_TRUE(shadow_previous_point(sample, hit));
  EXPECT_EQ(hit, (glm::vec<3, TypeParam>(0)));
}

TYPED_TEST(ShadowVector, FalloffIsOneOnThePlaneAndAGaussianOffIt) {
  using T = TypeParam;
  const glm::vec<3, T> hit(1, 2, 3), normal(0, 1, 0);
  const auto falloff = [&](T across, T up, T footprint) {
    return double(planarity_falloff(hit, hit + glm::vec<3, T>(across, up, 0), normal, footprint));
  };
  EXPECT_EQ(falloff(2, 0, T(0.01)), 1.0);
  EXPECT_EQ(falloff(0, T(0.005), T(0.01)), 1.0) << "within a pixel's footprint";
  const double angle = std::atan2(0.1, 1.0);
  EXPECT_NEAR(falloff(1, T(0.1), T(0.01)), std::exp(-angle * angle / 0.02), 1e-5);
  EXPECT_NEAR(falloff(1, T(-0.1), T(0.01)), std::exp(-angle * angle / 0.02), 1e-5);
  EXPECT_LT(falloff(1, 1, T(0.01)), 1e-10) << "45 degrees off";
}

// 2e-5 m of scenes 5 m across: the float's own rounding.
TEST(ShadowVectorPrecision, FloatAgreesWithDouble) {
  test::Random random(13);
  for (int trial = 0; trial < 300; ++trial) {
    const Shadowing setup = random_setup(random, trial % 2 == 0);
    glm::vec3 hit_float;
    glm::dvec3 hit_double;
    ASSERT_EQ(shadow_previous_point(sample_of<float>(setup), hit_float),
              shadow_previous_point(sample_of<double>(setup), hit_double));
    EXPECT_LT(glm::distance(glm::dvec3(hit_float), hit_double), 2e-5);
  }
}

}  // namespace
}  // namespace holdfast
