#include "core/kernels/random.h"

#include <cmath>
#include <set>

#include <gtest/gtest.h>

namespace holdfast {
namespace {

// First outputs of SplitMix64 seeded with 1234567 (Vigna's reference program).
TEST(RandomNumbers, AreThoseOfTheReferenceProgram) {
  const std::uint64_t expected[] = {6457827717110365317u, 3203168211198807973u,
                                    9817491932198370423u};
  std::uint64_t state = 1234567;
  for (const std::uint64_t want : expected)
    EXPECT_EQ(mix_bits(state += 0x9e3779b97f4a7c15ull), want);
}

TEST(RandomNumbers, FollowFromTheirKeyAlone) {
  for (const std::uint64_t key : {0ull, 1ull, 0xffffffffffffffffull}) {
    const UniformPair first = uniform_pair(key), again = uniform_pair(key);
    EXPECT_EQ(first.u, again.u);
    EXPECT_EQ(first.v, again.v);
  }
  static_assert(uniform_pair(7).u == uniform_pair(7).u);
}

TEST(RandomNumbers, StayInsideTheUnitIntervalAndDiffer) {
  std::set<std::pair<float, float>> seen;
  for (std::uint64_t key = 0; key < 100000; ++key) {
    const UniformPair pair = uniform_pair(key);
    ASSERT_TRUE(pair.u > 0.0f && pair.u < 1.0f && pair.v > 0.0f && pair.v < 1.0f) << key;
    seen.insert({pair.u, pair.v});
  }
  EXPECT_EQ(seen.size(), 100000u);
}

// Successive keys, as those of neighbouring pixels: moments of two independent uniform numbers, to
// five standard deviations of the mean of n samples.
TEST(RandomNumbers, OfSuccessiveKeysAreUniformAndUncorrelated) {
  const int n = 200000;
  double u = 0, v = 0, uu = 0, vv = 0, uv = 0, next = 0, previous = 0.5;
  for (int key = 0; key < n; ++key) {
    const UniformPair pair = uniform_pair(static_cast<std::uint64_t>(key));
    const double a = double(pair.u) - 0.5, b = double(pair.v) - 0.5;
    u += a;
    v += b;
    uu += a * a;
    vv += b * b;
    uv += a * b;
    next += a * previous;
    previous = a;
  }
  const double mean_error = 5 * std::sqrt(1.0 / 12 / n),
               square_error = 5 * std::sqrt(1.0 / 180 / n);
  EXPECT_NEAR(u / n, 0, mean_error);
  EXPECT_NEAR(v / n, 0, mean_error);
  EXPECT_NEAR(uu / n, 1.0 / 12, square_error);
  EXPECT_NEAR(vv / n, 1.0 / 12, square_error);
  EXPECT_NEAR(uv / n, 0, 5.0 / 12 / std::sqrt(n));
  EXPECT_NEAR(next / n, 0, 5.0 / 12 / std::sqrt(n));
}

}  // namespace
}  // namespace holdfast
