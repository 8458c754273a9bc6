#include "client/measure/flip.h"

#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "client/measure/flip_color.h"
#include "client/measure/flip_exposure.h"
#include "tests/measure/test_images.h"

// Expected values come from a direct evaluation of the published formulas in double precision, with
// two-dimensional filters, by a script in another language; float and separable filters agree with
// it to about 6e-5.
namespace holdfast::measure {
namespace {

constexpr double kTolerance = 1e-4;
// Where no feature is, rounding of 1e-8 in the detectors' sums passes through a square root.
constexpr double kConstantTolerance = 3e-4;

double mean(const std::vector<float>& map) {
  return std::accumulate(map.begin(), map.end(), 0.0) / static_cast<double>(map.size());
}

std::vector<float> flip(const Image& reference, const Image& test) {
  return FlipReference(reference, test::all(reference)).map(test);
}

double value(float x) { return static_cast<double>(x); }

TEST(Flip, IdenticalImagesDifferByNothing) {
  const Image grey = test::Noise(1).image(17, 24, 1), rgb = test::Noise(2).image(17, 24, 3);
  for (const float error : flip(grey, grey)) EXPECT_EQ(error, 0.0f);
  for (const float error : flip(rgb, rgb)) EXPECT_EQ(error, 0.0f);
}

TEST(Flip, BlackAgainstWhiteIsNearlyTheLargestError) {
  const auto map = flip(test::constant(11, 9, {0.0f}), test::constant(11, 9, {1.0f}));
  for (const float error : map) EXPECT_NEAR(value(error), 0.967380, kConstantTolerance);
}

TEST(Flip, GreenAgainstBlueIsOne) {
  const float distance =
      hyab_distance(hunt_lab_from_linear_rgb({0, 1, 0}), hunt_lab_from_linear_rgb({0, 0, 1}));
  EXPECT_NEAR(value(redistributed_color_error(distance)), 1.0, 1e-6);
}

TEST(Flip, ConstantGreysDifferAsTheirLightness) {
  const auto map = flip(test::constant(11, 9, {0.5f}), test::constant(11, 9, {0.6f}));
  for (const float error : map) EXPECT_NEAR(value(error), 0.196215, kConstantTolerance);
}

TEST(Flip, ConstantRadianceDiffersAsWorkedOut) {
  const auto grey = flip(test::constant(11, 9, {2, 2, 2}), test::constant(11, 9, {3, 3, 3}));
  for (const float error : grey) EXPECT_NEAR(value(error), 0.109126, kConstantTolerance);
  const auto color =
      flip(test::constant(11, 9, {0.2f, 0.5f, 0.1f}), test::constant(11, 9, {0.25f, 0.4f, 0.2f}));
  for (const float error : color) EXPECT_NEAR(value(error), 0.465993, kConstantTolerance);
}

TEST(Flip, GreyNoiseDiffersAsWorkedOut) {
  test::Noise noise(1);
  const Image reference = noise.image(17, 24, 1), test = noise.image(17, 24, 1);
  const auto map = flip(reference, test);
  EXPECT_NEAR(mean(map), 0.269559, kTolerance);
  EXPECT_NEAR(value(map[0]), 0.351916, kTolerance);            // the corner
  EXPECT_NEAR(value(map[12 * 17 + 8]), 0.094195, kTolerance);  // the middle
}

TEST(Flip, RadianceNoiseDiffersAsWorkedOut) {
  test::Noise noise(7);
  Image reference = noise.image(17, 24, 3), test = noise.image(17, 24, 3);
  for (float& x : reference.values) x = 10 * x * x * x * x;
  for (float& x : test.values) x = 10 * x * x * x * x;
  const FlipReference flip(reference, test::all(reference));
  ASSERT_EQ(flip.exposures().size(), 3u);
  EXPECT_NEAR(value(flip.exposures().front()), -1.947448, 1e-5);
  EXPECT_NEAR(value(flip.exposures().back()), 0.591439, 1e-5);
  const auto map = flip.map(test);
  EXPECT_NEAR(mean(map), 0.547306, kTolerance);
  EXPECT_NEAR(value(map[0]), 0.705503, kTolerance);
  EXPECT_NEAR(value(map[12 * 17 + 8]), 0.611866, kTolerance);
}

TEST(Flip, EdgeShiftedByOnePixelDiffersAsWorkedOut) {
  Image reference(17, 24, 1), test(17, 24, 1);
  for (int y = 0; y < 24; ++y)
    for (int x = 0; x < 17; ++x) {
      reference.values[static_cast<std::size_t>(y * 17 + x)] = x >= 8 ? 1.0f : 0.0f;
      test.values[static_cast<std::size_t>(y * 17 + x)] = x >= 9 ? 1.0f : 0.0f;
    }
  const auto map = flip(reference, test);
  EXPECT_NEAR(value(map[12 * 17 + 8]), 0.538174, kTolerance);
  EXPECT_NEAR(mean(map), 0.194720, 5e-4);  // the 0.7th power lifts rounding far from the edge
}

TEST(Flip, SkyIsBlackInBothImages) {
  const Image reference = test::constant(64, 1, {0.5f});
  Image test = reference;
  Mask surface = test::all(reference);
  for (std::size_t x = 0; x < 32; ++x) {
    surface[x] = 0;
    test.values[x] = 1.0f;
  }
  for (const float error : FlipReference(reference, surface).map(test)) EXPECT_EQ(error, 0.0f);
}

TEST(Flip, BlackRadianceHasOneExposure) {
  const Image black = test::constant(4, 4, {0, 0, 0});
  EXPECT_EQ(flip_exposures(black, test::all(black)), (std::vector<float>{0.0f}));
  for (const float error : flip(black, black)) EXPECT_EQ(error, 0.0f);
}

TEST(Flip, BlackMedianIsReplacedByThatOfThePositiveLuminances) {
  Image image = test::constant(5, 1, {0, 0, 0});
  for (int c = 0; c < 3; ++c) image.channel(c)[2] = 1;
  const auto exposures = flip_exposures(image, test::all(image));
  ASSERT_EQ(exposures.size(), 2u);
  for (const float exposure : exposures) EXPECT_TRUE(std::isfinite(exposure));
}

TEST(Flip, NumberOfExposuresIsBounded) {
  Image image = test::constant(5, 1, {1e-9f, 1e-9f, 1e-9f});
  for (int c = 0; c < 3; ++c) image.channel(c)[2] = 1e4f;
  EXPECT_EQ(flip_exposures(image, test::all(image)).size(), std::size_t{kMostFlipExposures});
}

TEST(Flip, ExtremeRadianceGivesFiniteErrors) {
  Image reference = test::constant(8, 8, {1, 1, 1}), test = reference;
  test.values[0] = 1e30f;
  test.values[1] = -1e30f;
  reference.values[5] = 1e30f;
  for (const float error : flip(reference, test)) {
    EXPECT_TRUE(std::isfinite(error));
    EXPECT_GE(error, 0.0f);
    EXPECT_LE(error, 1.0f);
  }
}

TEST(Flip, CubeRootOfLightnessIsExactEnough) {
  for (double grey = 0; grey <= 1; grey += 1.0 / 4096) {
    const double t = grey > std::pow(6.0 / 29, 3) ? std::cbrt(grey) : grey * 841 / 108 + 4.0 / 29;
    ASSERT_NEAR(value(lightness_of_grey(static_cast<float>(grey))), 116 * t - 16, 1e-4) << grey;
  }
}

}  // namespace
}  // namespace holdfast::measure
