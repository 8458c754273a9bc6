#include "core/motion/glossy_motion.h"

#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "core/motion/dual_motion.h"
#include "tests/core/mirror_oracle.h"
#include "tests/core/small_world.h"

namespace holdfast {
namespace {

constexpr int kWidth = 320, kHeight = 180;

template <class T>
class GlossyVector : public testing::Test {
 public:
  /// Pixels of an image 320 wide, of points metres away: rounding alone.
  static constexpr double kPixels = std::is_same_v<T, float> ? 2e-3 : 1e-9;
  /// The axis is the difference of two pixels, for floats only some tenths of a pixel apart.
  static constexpr double kAxis = std::is_same_v<T, float> ? 2e-3 : 1e-6;
};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(GlossyVector, Scalars);

/// A mirror below the eye that has moved rigidly, and a point above it that has moved, too.
struct Mirrored {
  ViewGeometry view;
  glm::dvec3 surface, normal, hit;  ///< relative to the camera
};

Mirrored random_mirror(test::Random& random) {
  const glm::dvec3 eye(random.uniform(-1, 1), random.uniform(1, 2), 0);
  Mirrored m{
      ViewGeometry(test::perspective_camera(kWidth, kHeight, eye, {0, -0.4, -1}), kWidth, kHeight),
      {},
      {},
      {}};
  const glm::dmat4 mirror = test::random_rigid(random, 0.2, 0.2);
  m.normal = glm::normalize(glm::dvec3(mirror[1]));
  m.surface = glm::dvec3(mirror * glm::dvec4(0, 0, -4, 1)) - eye;
  const glm::dmat4 object = test::random_rigid(random, 3, 0.5);
  m.hit = glm::dvec3(0, 1.5, -5) + glm::dvec3(object * glm::dvec4(0.3, 0, 0, 1)) - eye;
  return m;
}

TYPED_TEST(GlossyVector, OfAMirrorLeadsToThePixelThatSeesThePointReflected) {
  using T = TypeParam;
  test::Random random(51);
  for (int trial = 0; trial < 200; ++trial) {
    const Mirrored m = random_mirror(random);
    const glm::mat<4, 4, T> pixel(m.view.pixel_from_relative);
    const auto image =
        project(pixel, virtual_image(glm::vec<4, T>(glm::dvec4(m.hit, 1)),
                                     glm::vec<3, T>(m.surface), glm::vec<3, T>(m.normal)));
    ASSERT_TRUE(image.in_front);
    const glm::dvec2 seen = test::pixel_that_sees_reflected(m.view, m.surface, m.normal, m.hit);
    EXPECT_NEAR(double(image.x), seen.x, this->kPixels) << trial;
    EXPECT_NEAR(double(image.y), seen.y, this->kPixels) << trial;
  }
}

TYPED_TEST(GlossyVector, OfTheSkyMirrorsItsDirectionWhereverTheMirrorStands) {
  using T = TypeParam;
  test::Random random(52);
  for (int trial = 0; trial < 50; ++trial) {
    const glm::dvec3 normal = glm::normalize(random.in_box(1) + glm::dvec3(0, 2, 0));
    const glm::dvec3 direction = glm::normalize(random.in_box(1));
    const glm::dvec3 expected = glm::reflect(direction, normal);
    const auto image = virtual_image(glm::vec<4, T>(glm::dvec4(direction, 0)),
                                     glm::vec<3, T>(random.in_box(1000)), glm::vec<3, T>(normal));
    EXPECT_LT(glm::distance(glm::dvec3(image), expected), 1e-6);
    EXPECT_EQ(image.w, T(0));
  }
}

TYPED_TEST(GlossyVector, SpreadIsNoneForMirrorsAndAtContactAndFiniteForTheSky) {
  using T = TypeParam;
  const T inf = std::numeric_limits<T>::infinity();
  for (const T hit : {T(0), T(1e-3), T(5), T(1e30), inf}) {
    const auto mirror = glossy_spread(T(300), T(0), T(4), hit, T(0.7));
    EXPECT_EQ(mirror.in_plane, T(0));
    EXPECT_EQ(mirror.out_of_plane, T(0));
    const auto rough = glossy_spread(T(300), T(1), T(4), hit, T(0.7));
    EXPECT_TRUE(rough.in_plane >= T(0) && rough.in_plane <= T(kWidestGlossySpreadPx)) << hit;
    EXPECT_EQ(rough.out_of_plane, rough.in_plane * T(0.7));
  }
  EXPECT_EQ(glossy_spread(T(300), T(1), T(4), T(0), T(0.7)).in_plane, T(0));
  EXPECT_EQ(glossy_spread(T(300), T(1), T(0), T(0), T(0.7)).in_plane, T(0)) << "at the eye";
  EXPECT_EQ(glossy_spread(T(300), T(0.5), T(4), inf, T(1)).in_plane, T(kWidestGlossySpreadPx));
  EXPECT_NEAR(double(glossy_spread(T(300), T(0.01), T(4), inf, T(1)).in_plane),
              std::sqrt(2.0) * 3.0, 1e-5);
}

/// Standard deviations along and across the plane of incidence of the pixels whose half vector lies
/// in the lobe: each pixel around the mirror's counts by the density of its half vector's slopes.
/// The density is that of Beckmann's lobe of the same alpha, whose slopes have the variance
/// alpha^2 / 2 of the formula; that of GGX's has no limit.
glm::dvec2 spread_of_half_vectors(double alpha, double view_m, double hit_m, double angle) {
  const double focal_px = 300;
  // The plane z = 0 with the surface point at the origin; incidence in the plane y = 0.
  const glm::dvec3 eye = view_m * glm::dvec3(-std::sin(angle), 0, std::cos(angle));
  const glm::dvec3 hit = hit_m * glm::dvec3(std::sin(angle), 0, std::cos(angle));
  const glm::dvec3 forward = glm::normalize(-eye), right(0, 1, 0);
  const glm::dvec3 up = glm::cross(right, forward);
  glm::dvec2 sum(0);
  double weights = 0;
  for (double v = -60; v <= 60; v += 0.5)
    for (double u = -60; u <= 60; u += 0.5) {
      const glm::dvec3 ray = focal_px * forward + u * right + v * up;
      if (ray.z >= 0) continue;
      const glm::dvec3 surface = eye - eye.z / ray.z * ray;
      const glm::dvec3 half =
          glm::normalize(glm::normalize(eye - surface) + glm::normalize(hit - surface));
      const double slope2 = (half.x * half.x + half.y * half.y) / (half.z * half.z);
      const double weight = std::exp(-slope2 / (alpha * alpha));
      sum += weight * glm::dvec2(v * v, u * u);
      weights += weight;
    }
  return glm::sqrt(sum / weights);
}

// The formula is of first order in the slopes: 10 % off at most for near hits seen at 55 degrees.
TEST(GlossySpread, AgreesWithANumericalCheckOfHalfVectors) {
  for (const double alpha : {0.02, 0.04})
    for (const double hit_m : {0.5, 4.0, 50.0})
      for (const double degrees : {0.0, 30.0, 55.0}) {
        const double angle = degrees * std::numbers::pi / 180;
        const glm::dvec2 want = spread_of_half_vectors(alpha, 4.0, hit_m, angle);
        const auto spread = glossy_spread(300.0, alpha, 4.0, hit_m, std::cos(angle));
        ASSERT_LT(spread.in_plane, double{kWidestGlossySpreadPx} - 0.01) << "must not be capped";
        EXPECT_NEAR(spread.in_plane, want.x, 0.1 * want.x)
            << alpha << ' ' << hit_m << ' ' << degrees;
        EXPECT_NEAR(spread.out_of_plane, want.y, 0.1 * want.y)
            << alpha << ' ' << hit_m << ' ' << degrees;
      }
}

TYPED_TEST(GlossyVector, IncidenceAxisIsTheLineOnWhichReflectionsOfOneRayLie) {
  using T = TypeParam;
  test::Random random(53);
  for (int trial = 0; trial < 100; ++trial) {
    const Mirrored m = random_mirror(random);
    const auto foot = project(m.view.pixel_from_relative, m.surface);
    const auto axis = incidence_axis(glm::mat<4, 4, T>(m.view.pixel_from_relative),
                                     glm::vec<3, T>(m.surface), glm::vec<3, T>(m.normal));
    EXPECT_NEAR(double(glm::length(axis)), 1, 1e-5);
    // Any point of the reflected ray is in the plane of incidence.
    const glm::dvec3 along = glm::reflect(glm::normalize(m.surface), m.normal);
    const auto other = project(m.view.pixel_from_relative, m.surface + 0.5 * along);
    const glm::dvec2 line = glm::normalize(glm::dvec2(other.x - foot.x, other.y - foot.y));
    EXPECT_NEAR(double(axis.x) * line.y - double(axis.y) * line.x, 0, this->kAxis) << trial;
  }
}

TYPED_TEST(GlossyVector, IncidenceAxisOfASurfaceSeenStraightOnIsAUnitVector) {
  using T = TypeParam;
  const ViewGeometry view(test::perspective_camera(kWidth, kHeight), kWidth, kHeight);
  const glm::mat<4, 4, T> pixel(view.pixel_from_relative);
  for (const T depth : {T(0.2), T(5), T(1e6)}) {
    const auto axis = incidence_axis(pixel, glm::vec<3, T>(0, 0, -depth), glm::vec<3, T>(0, 0, 1));
    EXPECT_NEAR(double(glm::length(axis)), 1, 1e-6);
  }
  const auto behind = incidence_axis(pixel, glm::vec<3, T>(0, 0, 3), glm::vec<3, T>(0, 1, 0));
  EXPECT_EQ(behind, (glm::vec<2, T>(1, 0)));
}

TYPED_TEST(GlossyVector, DualVectorKeepsTheOffsetToTheOccluder) {
  using V = glm::vec<2, TypeParam>;
  // The occluder went 3 right and 1 down: what is left of it now was 3 left and 1 up of itself.
  EXPECT_EQ(dual_previous_pixel(V(40, 20), V(40, 20), V(43, 21)), V(37, 19));
  // Its own motion and the camera's add up: the surface vector led elsewhere.
  EXPECT_EQ(dual_previous_pixel(V(40, 20), V(45, 22), V(43, 21)), V(42, 21));
}

// 2e-3 px: rounding of floats of up to 320 px through one matrix.
TEST(GlossyVectorPrecision, FloatAgreesWithDouble) {
  test::Random random(54);
  for (int trial = 0; trial < 200; ++trial) {
    const Mirrored m = random_mirror(random);
    const auto exact = virtual_image(glm::dvec4(m.hit, 1), m.surface, m.normal);
    const auto single =
        virtual_image(glm::vec4(glm::dvec4(m.hit, 1)), glm::vec3(m.surface), glm::vec3(m.normal));
    EXPECT_LT(glm::distance(glm::dvec4(single), exact), 5e-6);
    const double alpha = random.uniform(0, 0.1), hit_m = random.uniform(0, 20);
    const auto spread = glossy_spread(300.0, alpha, 4.0, hit_m, 0.6);
    const auto spread_single =
        glossy_spread(300.0f, static_cast<float>(alpha), 4.0f, static_cast<float>(hit_m), 0.6f);
    EXPECT_NEAR(double(spread_single.in_plane), spread.in_plane, 1e-5);
    EXPECT_NEAR(double(spread_single.out_of_plane), spread.out_of_plane, 1e-5);
  }
}

}  // namespace
}  // namespace holdfast
