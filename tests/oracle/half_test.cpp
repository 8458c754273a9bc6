// Components at half resolution and back again, through the kernels, against the oracle.

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include "tests/core/isa_guard.h"
#include "tests/oracle/within_budget.h"

namespace holdfast {
namespace {

using namespace stability;

using Choice = std::vector<std::string>;

class Half : public testing::TestWithParam<std::string> {
 protected:
  void compare(int width, int height, int frames, const Choice& choice) {
    for (const OracleScene& scene : oracle_scenes(width, height, frames)) {
      SCOPED_TRACE(scene.name + " " + std::to_string(width) + "x" + std::to_string(height));
      DenoiserConfig config = scene.config;
      config.recipe = GetParam();
      config.half_resolution = choice;
      test::expect_within_budget(filter_frames(config, "balanced", scene.frames),
                                 filter_by_oracle(config, "balanced", scene.frames));
    }
  }
};

const Choice kAll = {"indirect", "glossy", "visibility"};

TEST_P(Half, AgreesWithTheOracle) { compare(64, 48, 6, kAll); }

TEST_P(Half, AgreesWithTheOracleAtOddAndTinySizes) {
  for (const auto& [width, height] : {std::pair{1, 1}, {1, 6}, {3, 2}, {17, 9}, {67, 5}, {133, 5}})
    compare(width, height, 3, kAll);
}

TEST_P(Half, OneComponentAloneAgreesWithTheOracle) {
  compare(32, 24, 4, {"indirect"});
  compare(32, 24, 4, {"glossy"});
  compare(32, 24, 4, {"visibility"});
}

std::string name_of(const testing::TestParamInfo<std::string>& info) {
  std::string name = info.param;
  for (char& c : name) c = c == '-' ? '_' : c;
  return name;
}

INSTANTIATE_TEST_SUITE_P(All, Half, testing::ValuesIn(recipe_names()), name_of);

OracleScene moving_scene(int width, int height, int frames) {
  OracleScene scene = std::move(oracle_scenes(width, height, frames).front());
  scene.config.half_resolution = kAll;
  return scene;
}

TEST(HalfVariants, EveryBasisOfIndirectLightAgreesWithTheOracle) {
  OracleScene scene = moving_scene(49, 33, 5);
  for (const char* basis : {"irradiance", "luminance-cones", "cones"}) {
    SCOPED_TRACE(basis);
    scene.config.indirect_basis = basis;
    test::expect_within_budget(filter_frames(scene.config, "accurate", scene.frames),
                               filter_by_oracle(scene.config, "accurate", scene.frames));
  }
}

TEST(HalfVariants, EveryInstructionSetAndNumberOfThreadsAgreesWithTheOracle) {
  const test::IsaGuard guard;
  const tbb::global_control most(tbb::global_control::max_allowed_parallelism, 4);
  const OracleScene scene = moving_scene(65, 47, 4);
  for (const char* preset : {"fast", "accurate"}) {
    const Results doubles = filter_by_oracle(scene.config, preset, scene.frames);
    for (const Isa isa : available_isas())
      for (const int threads : {1, 4}) {
        SCOPED_TRACE(std::string(preset) + " " + std::string(isa_name(isa)) + " on " +
                     std::to_string(threads));
        select_isa(isa);
        Results floats;
        tbb::task_arena(threads).execute(
            [&] { floats = filter_frames(scene.config, preset, scene.frames); });
        test::expect_within_budget(floats, doubles);
      }
  }
}

TEST(HalfVariants, ErrorsStayWithinTheBudgetOverManyFrames) {
  const OracleScene scene = moving_scene(48, 32, 24);
  test::expect_within_budget(filter_frames(scene.config, "accurate", scene.frames),
                             filter_by_oracle(scene.config, "accurate", scene.frames));
}

// Without this the tests above might compare two full resolutions.
TEST(HalfVariants, TheOracleAtHalfResolutionIsNotTheOneAtFull) {
  OracleScene scene = moving_scene(32, 24, 3);
  const Results half = filter_by_oracle(scene.config, "balanced", scene.frames);
  scene.config.half_resolution = {"none"};
  const Results full = filter_by_oracle(scene.config, "balanced", scene.frames);
  for (const OracleErrors& errors : oracle_errors(half, full)) {
    EXPECT_FALSE(errors.within_budget()) << plane_name(errors.plane);
  }
}

}  // namespace
}  // namespace holdfast
