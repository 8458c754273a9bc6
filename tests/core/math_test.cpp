#include "core/kernels/math.h"

#include <limits>
#include <numbers>

#include <gtest/gtest.h>

namespace holdfast {
namespace {

// A Taylor polynomial of degree 5 on [-1/2, 1/2] leaves ln(2)^6 / 6! / 2^6 = 2.4e-6 of 1 / sqrt(2),
// the float argument of the power of two up to 2.6e-6 more where it is above 64; and taking 2^-126
// off, so that the end is 0, adds that much absolutely.
TEST(ExpNonpositive, AgreesWithTheStandardLibrary) {
  double worst = 0;
  for (int k = 0; k <= 1'000'000; ++k) {
    const float x = -100.0f * static_cast<float>(k) * 1e-6f;
    const double want = std::exp(double(x));
    const double error = std::abs(double(exp_nonpositive(x)) - want) - 1.3e-38;
    worst = std::max(worst, error / want);
  }
  EXPECT_LE(worst, 6e-6);
}

TEST(ExpNonpositive, IsExactlyOneAtZeroAndExactlyZeroFarBelow) {
  EXPECT_EQ(exp_nonpositive(0.0f), 1.0f);
  EXPECT_EQ(exp_nonpositive(-0.0f), 1.0f);
  for (const float x : {-88.0f, -128.0f, -1e6f, -1e30f, -std::numeric_limits<float>::infinity()})
    EXPECT_EQ(exp_nonpositive(x), 0.0f) << x;
}

TEST(ExpNonpositive, IsNeverNegativeAndNeverGrowsAsItsArgumentFalls) {
  float last = 1.0f;
  for (int k = 0; k <= 400'000; ++k) {
    const float value = exp_nonpositive(-0.00025f * static_cast<float>(k));
    ASSERT_GE(value, 0.0f);
    ASSERT_LE(value, last * (1.0f + 1e-5f));  // both ends of a piece miss by 2.4e-6 and 3.4e-6
    last = value;
  }
}

TEST(ExpNonpositive, OfNaNIsFinite) {
  EXPECT_TRUE(std::isfinite(exp_nonpositive(std::numeric_limits<float>::quiet_NaN())));
}

TEST(ExpNonpositive, InDoubleIsTheStandardLibrarys) {
  EXPECT_EQ(exp_nonpositive(-1.25), std::exp(-1.25));
}

TEST(Luminance, IsRec709) {
  EXPECT_DOUBLE_EQ(luminance(1.0, 0.0, 0.0), 0.2126);
  EXPECT_DOUBLE_EQ(luminance(0.0, 1.0, 0.0), 0.7152);
  EXPECT_NEAR(luminance(1.0, 1.0, 1.0), 1.0, 1e-12);
}

TEST(LogOf, AgreesWithTheStandardLibrary) {
  for (float x = 1e-37f; x < 1e37f; x *= 1.0013f) {
    const double want = std::log(double(x));
    ASSERT_NEAR(double(log_of(x)), want, 3e-7 * (1 + std::abs(want))) << x;
  }
  EXPECT_EQ(log_of(1.0f), 0.0f);
}

TEST(SineOfQuarter, AgreesWithTheStandardLibrary) {
  for (int k = -10'000; k <= 10'000; ++k) {
    const float v = 0.25f * static_cast<float>(k) * 1e-4f;
    ASSERT_NEAR(double(sine_of_quarter(v)), std::sin(2 * std::numbers::pi * double(v)), 3e-7) << v;
  }
}

}  // namespace
}  // namespace holdfast
