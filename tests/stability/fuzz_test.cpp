#include "tests/stability/fuzz.h"

#include <gtest/gtest.h>

namespace holdfast::test {
namespace {

TEST(Fuzz, AnySessionIsFilteredToFiniteResultsOrRefused) {
  int opened = 0, filtered = 0, refused = 0;
  constexpr int kSessions = 1500;
  for (std::uint32_t seed = 0; seed < kSessions; ++seed) {
    const FuzzOutcome outcome = fuzz_session(seed);
    EXPECT_EQ(outcome.problem, "");
    opened += outcome.opened ? 1 : 0;
    filtered += outcome.filtered;
    refused += outcome.refused;
  }
  // Most of it gets past the checks, and some does not.
  EXPECT_GT(opened, kSessions / 2);
  EXPECT_GT(filtered, 2 * opened);
  EXPECT_GT(refused, opened / 4);
}

TEST(Fuzz, SeedsThatOnceFailedPass) {
  // Pixels of 1e-9 m: rounding took each point off its own plane, weights vanished, and 0/0 was
  // left.
  EXPECT_EQ(fuzz_session(5001473).problem, "");
}

}  // namespace
}  // namespace holdfast::test
