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

// The polynomial leaves 2.6e-6, and the bits of the power up to 32 of 2^23 ln 2: 2.6e-6.
TEST(WeightExp, AgreesWithTheStandardLibraryDownToTheLeastNormal) {
  for (const float h : {1.0f, 0.5f, 3.0f / 8, 1.0f / 256}) {
    double worst = 0;
    const float bits = weight_bits(std::log2(h));
    for (int k = 0; k <= 400'000; ++k) {
      const float s = 100.0f * static_cast<float>(k) / 400'000.0f;
      const double want = double(h) * std::exp(-double(s));
      if (want > 1.3e-38)
        worst = std::max(worst, std::abs(double(weight_exp(bits, s)) - want) / want);
    }
    EXPECT_LE(worst, 7.5e-6) << h;
    EXPECT_GT(worst, 1e-6) << h;
  }
}

TEST(WeightExp, IsExactlyZeroFarAwayAndNeverNegative) {
  const float bits = weight_bits(0.0f);
  for (const float s : {88.1f, 128.0f, 1e6f, 1e30f, std::numeric_limits<float>::infinity()})
    EXPECT_EQ(weight_exp(bits, s), 0.0f) << s;
  for (float s = 80.0f; s < 90.0f; s += 0.001f) ASSERT_GE(weight_exp(bits, s), 0.0f) << s;
}

TEST(PositivePart, IsTheMaximumWithZero) {
  for (const float x : {1e-40f, 1e-30f, 1.0f, 3e38f}) {
    EXPECT_EQ(positive_part(x), x);
    EXPECT_EQ(positive_part(-x), 0.0f);
  }
  EXPECT_EQ(positive_part(0.0f), 0.0f);
  EXPECT_EQ(positive_part(-std::numeric_limits<float>::infinity()), 0.0f);
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
