// The same frames under every instruction set, number of threads, kind of light and choice of a
// preset, against the oracle.

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include "tests/core/isa_guard.h"
#include "tests/oracle/within_budget.h"

namespace holdfast {
namespace {

using namespace stability;

constexpr const char* kRecipes[] = {"reliable", "paper", "svgf", "clamp"};

OracleScene moving_scene(int width, int height, int frames) {
  return std::move(oracle_scenes(width, height, frames).front());
}

TEST(Variants, EveryInstructionSetAndNumberOfThreadsAgreesWithTheOracle) {
  const test::IsaGuard guard;
  const tbb::global_control most(tbb::global_control::max_allowed_parallelism, 4);
  OracleScene scene = moving_scene(64, 48, 4);
  for (const char* recipe : kRecipes) {
    scene.config.recipe = recipe;
    const Results doubles = filter_by_oracle(scene.config, "balanced", scene.frames);
    for (const Isa isa : available_isas())
      for (const int threads : {1, 4}) {
        SCOPED_TRACE(std::string(recipe) + " " + std::string(isa_name(isa)) + " on " +
                     std::to_string(threads));
        select_isa(isa);
        Results floats;
        tbb::task_arena(threads).execute(
            [&] { floats = filter_frames(scene.config, "balanced", scene.frames); });
        test::expect_within_budget(floats, doubles);
      }
  }
}

TEST(Variants, ErrorsStayWithinTheBudgetOverManyFrames) {
  OracleScene scene = moving_scene(48, 32, 24);
  for (const char* recipe : {"reliable", "svgf"}) {
    SCOPED_TRACE(recipe);
    scene.config.recipe = recipe;
    test::expect_within_budget(filter_frames(scene.config, "balanced", scene.frames),
                               filter_by_oracle(scene.config, "balanced", scene.frames));
  }
}

TEST(Variants, EveryBasisOfIndirectLightAgreesWithTheOracle) {
  OracleScene scene = moving_scene(48, 32, 5);
  for (const char* basis : {"irradiance", "luminance-cones", "cones"}) {
    SCOPED_TRACE(basis);
    scene.config.indirect_basis = basis;
    test::expect_within_budget(filter_frames(scene.config, "accurate", scene.frames),
                               filter_by_oracle(scene.config, "accurate", scene.frames));
  }
}

TEST(Variants, TheNarrowKernelAgreesWithTheOracle) {
  OracleScene scene = moving_scene(48, 32, 4);
  scene.config.preset = "fast";
  scene.config.half_resolution = {"none"};
  for (const char* recipe : kRecipes) {
    SCOPED_TRACE(recipe);
    scene.config.recipe = recipe;
    test::expect_within_budget(filter_frames(scene.config, "fast", scene.frames),
                               filter_by_oracle(scene.config, "fast", scene.frames));
  }
}

TEST(Variants, EveryShapeOfLightAgreesWithTheOracle) {
  for (const LightShape shape :
       {LightShape::kDisk, LightShape::kSphere, LightShape::kPoint, LightShape::kDirectional}) {
    SCOPED_TRACE(light_shape_name(shape));
    World world;
    world.light.shape = shape;
    DenoiserConfig config = session_of(world);
    std::vector<Frame> frames;
    for (int t = 0; t < 4; ++t) frames.push_back(render(world, t));
    for (const char* recipe : {"reliable", "paper"}) {
      config.recipe = recipe;
      test::expect_within_budget(filter_frames(config, "balanced", frames),
                                 filter_by_oracle(config, "balanced", frames));
    }
  }
}

}  // namespace
}  // namespace holdfast
