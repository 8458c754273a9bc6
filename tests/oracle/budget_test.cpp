// What a budget catches.

#include "tests/oracle/within_budget.h"

namespace holdfast {
namespace {

using namespace stability;

constexpr PlaneId kGlossy{PlaneKind::kGlossy, {}};

Results flat(float value) {
  Results results(1);
  Plane& plane = results[0].add(kGlossy, 100, 10);
  for (int c = 0; c < 3; ++c)
    for (int y = 0; y < 10; ++y)
      for (int x = 0; x < 100; ++x) plane.channel(c).at(x, y) = value;
  return results;
}

OracleErrors errors_of(const Results& floats) { return oracle_errors(floats, flat(2.0f)).front(); }

TEST(Budget, EqualResultsHaveNoErrors) {
  const OracleErrors errors = errors_of(flat(2.0f));
  EXPECT_EQ(errors.rms, 0);
  EXPECT_EQ(errors.tipped_share, 0);
  EXPECT_TRUE(errors.within_budget());
}

TEST(Budget, ErrorsAreSharesOfTheLargestValue) {
  const double small = 0.25 * oracle_budget(PlaneKind::kGlossy).tipped;
  const OracleErrors errors = errors_of(flat(static_cast<float>(2 + 2 * small)));
  EXPECT_NEAR(errors.rms, small, 0.01 * small);
  EXPECT_NEAR(errors.largest, small, 0.01 * small);
}

TEST(Budget, AFewTippedPixelsAreCountedAndManyAreNotForgiven) {
  const OracleBudget& budget = oracle_budget(PlaneKind::kGlossy);
  Results floats = flat(2.0f);
  const auto tip = [&](int pixels) {
    for (int k = 0; k < pixels; ++k) floats[0].find(kGlossy)->channel(1).at(k % 100, k / 100) = 3;
  };
  tip(static_cast<int>(budget.share * 1000));
  EXPECT_TRUE(errors_of(floats).within_budget());
  EXPECT_NEAR(errors_of(floats).largest_tip, 0.5, 1e-6);
  tip(static_cast<int>(budget.share * 1000) + 2);
  EXPECT_FALSE(errors_of(floats).within_budget());
}

TEST(Budget, ASmallErrorOfAllPixelsIsNoTip) {
  const OracleBudget& budget = oracle_budget(PlaneKind::kGlossy);
  EXPECT_FALSE(errors_of(flat(static_cast<float>(2 + 3 * budget.rms))).within_budget());
}

TEST(Budget, AValueThatIsNotFiniteIsBeyondAnyBudget) {
  Results floats = flat(2.0f);
  floats[0].find(kGlossy)->channel(2).at(5, 5) = NAN;
  EXPECT_FALSE(errors_of(floats).within_budget());
}

}  // namespace
}  // namespace holdfast
