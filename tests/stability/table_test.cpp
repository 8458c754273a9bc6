#include "client/stability/table.h"

#include <set>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/frame/error.h"
#include "core/kernels/isa.h"

namespace holdfast::stability {

void PrintTo(const Entry& entry, std::ostream* out) { *out << entry.input; }

namespace {

/// The one that accuracy is promised of, and those that differ most from it.
const std::vector<std::string> kRecipes{"reliable", "paper", "svgf"};

std::vector<Entry> small_entries() {
  std::vector<Entry> entries = all_entries();
  std::erase_if(entries, [](const Entry& e) { return e.cost != Entry::Cost::kSmall; });
  return entries;
}

class Extremes : public testing::TestWithParam<Entry> {};

TEST_P(Extremes, StayWithinTheirLimits) {
  const Finding finding = measure(GetParam(), kRecipes);
  EXPECT_TRUE(finding.passed) << stability_markdown({finding});
}

INSTANTIATE_TEST_SUITE_P(Table, Extremes, testing::ValuesIn(small_entries()),
                         [](const testing::TestParamInfo<Entry>& row) {
                           std::string name = row.param.name;
                           for (char& c : name)
                             if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
                           return name + "_" + std::to_string(row.index);
                         });

// What differs between them is rounding, which rows of scales look for.
TEST(StabilityTable, ScalesAlikeOnEveryInstructionSet) {
  const Isa before = selected_isa();
  std::vector<Entry> entries = small_entries();
  std::erase_if(entries, [](const Entry& e) { return e.limit.others != kScaled.others; });
  ASSERT_GE(entries.size(), 10u);
  for (const Isa isa : available_isas()) {
    select_isa(isa);
    for (const Entry& entry : entries) {
      const Finding finding = measure(entry, kRecipes);
      EXPECT_TRUE(finding.passed) << isa_name(isa) << stability_markdown({finding});
    }
  }
  select_isa(before);
}

Entry with_error(double error) {
  return {"a", "b", "c", {1, 2}, [=](const std::string&) { return error; }};
}

TEST(StabilityTable, FailsARowWhoseErrorIsBeyondItsRecipesLimit) {
  EXPECT_TRUE(measure(with_error(1.5), {"svgf"}).passed);
  EXPECT_FALSE(measure(with_error(1.5), {"svgf", "reliable"}).passed);
  EXPECT_FALSE(measure(with_error(HUGE_VAL), {"svgf"}).passed);
  EXPECT_FALSE(measure(with_error(std::nan("")), {"svgf"}).passed);
}

TEST(StabilityTable, FailsARowThatThrowsAndSaysWhat) {
  const Entry entry{"a", "b", "c", 1,
                    [](const std::string&) -> double { throw std::runtime_error("out of luck"); }};
  const Finding finding = measure(entry, {"reliable"});
  EXPECT_FALSE(finding.passed);
  EXPECT_FALSE(all_passed({finding}));
  EXPECT_NE(stability_markdown({finding}).find("**fail**: out of luck"), std::string::npos);
  const auto json = stability_json({finding});
  EXPECT_EQ(json["passed"], false);
  EXPECT_EQ(json["entries"][0]["failure"], "out of luck");
  EXPECT_TRUE(json["entries"][0]["errors"]["reliable"].is_null());
}

TEST(StabilityTable, RefusesAnUnknownRecipe) {
  EXPECT_THROW(measure_table({.recipes = {"magic"}}, [](const std::string&) {}), InputError);
}

TEST(StabilityTable, NamesEachRowOnce) {
  std::set<std::string> names;
  for (const Entry& entry : all_entries())
    EXPECT_TRUE(names.insert(entry.name).second) << entry.name;
}

}  // namespace
}  // namespace holdfast::stability
