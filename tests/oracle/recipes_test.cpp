// Whole frames of every recipe through the kernels, against the oracle.

#include <vector>

#include "tests/oracle/within_budget.h"

namespace holdfast {
namespace {

using namespace stability;

class Recipes : public testing::TestWithParam<std::string> {
 protected:
  void compare(int width, int height, int frames) {
    for (const OracleScene& scene : oracle_scenes(width, height, frames)) {
      SCOPED_TRACE(scene.name + " " + std::to_string(width) + "x" + std::to_string(height));
      DenoiserConfig config = scene.config;
      config.recipe = GetParam();
      test::expect_within_budget(filter_frames(config, "balanced", scene.frames),
                                 filter_by_oracle(config, "balanced", scene.frames));
    }
  }
};

TEST_P(Recipes, AgreeWithTheOracle) { compare(64, 48, 6); }

TEST_P(Recipes, AgreeWithTheOracleAtSizesThatFillNoBlock) {
  for (const auto& [width, height] :
       {std::pair{1, 1}, {2, 3}, {17, 9}, {67, 5}, {133, 5}, {5, 133}})
    compare(width, height, 3);
}

TEST_P(Recipes, AgreeWithTheOracleWhenAnObjectIsPlacedForTheFirstTime) {
  std::vector<OracleScene> scenes = oracle_scenes(64, 48, 4);
  OracleScene& scene = scenes[0];
  for (int t = 0; t < 2; ++t) scene.frames[static_cast<std::size_t>(t)].objects.clear();
  DenoiserConfig config = scene.config;
  config.recipe = GetParam();
  test::expect_within_budget(filter_frames(config, "balanced", scene.frames),
                             filter_by_oracle(config, "balanced", scene.frames));
}

std::string name_of(const testing::TestParamInfo<std::string>& info) {
  std::string name = info.param;
  for (char& c : name) c = c == '-' ? '_' : c;
  return name;
}

INSTANTIATE_TEST_SUITE_P(All, Recipes, testing::ValuesIn(recipe_names()), name_of);

}  // namespace
}  // namespace holdfast
