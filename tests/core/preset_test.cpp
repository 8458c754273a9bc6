#include "core/denoiser/preset.h"

#include <gtest/gtest.h>

#include "core/denoiser/plan.h"
#include "tests/core/denoiser_world.h"
#include "tests/core/expect_input_error.h"
#include "tests/core/preset_world.h"

namespace holdfast {
namespace {

using test::config_of;

PlaneSet last_of(const DenoiserConfig& config, int frames) {
  Denoiser denoiser(config);
  PlaneSet results;
  for (int index = 0; index < frames; ++index)
    denoiser.filter(test::noisy_frame(config, index), results);
  return results;
}

TEST(Preset, NamesAreListedFastestFirst) {
  EXPECT_EQ(preset_names(),
            (std::vector<std::string>{"fast", "balanced", "accurate", "reference"}));
}

TEST(Preset, BalancedTakesEveryRecipeAsItIs) {
  for (const Recipe& recipe : all_recipes()) {
    DenoiserConfig config = config_of("balanced");
    config.recipe = recipe.name;
    const Plan plan = Plan::make(config);
    EXPECT_EQ(plan.recipe.indirect_basis, recipe.indirect_basis);
    for (const Plan::Entry& entry : plan.components) {
      EXPECT_FALSE(entry.half);
      const Recipe own = plan.recipe_of(entry);
      EXPECT_EQ(own.radiance_filter.levels, recipe.radiance_filter.levels);
      EXPECT_EQ(own.visibility_filter.levels, recipe.visibility_filter.levels);
      EXPECT_EQ(own.radiance_filter.taps, 13);
    }
  }
}

TEST(Preset, ABasisIsOfRecipesThatKeepConesUnlessItIsAskedFor) {
  DenoiserConfig config = config_of("accurate");
  EXPECT_EQ(Plan::make(config).recipe.indirect_basis, RadianceBasis::kConesColour);
  config.recipe = "traditional";
  EXPECT_EQ(Plan::make(config).recipe.indirect_basis, RadianceBasis::kIrradiance);
  config.indirect_basis = "luminance-cones";
  EXPECT_EQ(Plan::make(config).recipe.indirect_basis, RadianceBasis::kConesLuminance);
}

TEST(Preset, WhatAConfigurationChoosesReplacesThePresetsChoice) {
  const auto halves = [](const DenoiserConfig& config) {
    int count = 0;
    for (const Plan::Entry& entry : Plan::make(config).components) count += entry.half ? 1 : 0;
    return count;
  };
  DenoiserConfig config = config_of("fast");
  EXPECT_EQ(halves(config), 4) << "two lights";
  config.half_resolution = {"none"};
  EXPECT_EQ(halves(config), 0);
  config = config_of("balanced");
  config.half_resolution = {"indirect"};
  EXPECT_EQ(halves(config), 1);
  config.half_resolution = {"indirect", "glossy"};
  EXPECT_EQ(halves(config), 2);
  config.half_resolution = {"visibility"};
  EXPECT_EQ(halves(config), 2);
  config.indirect_basis = "irradiance";
  EXPECT_EQ(Plan::make(config).recipe.indirect_basis, RadianceBasis::kIrradiance);
  const int levels = Plan::make(config).recipe.radiance_filter.levels;
  config.kernel_taps = 9;
  config.more_levels = -1;
  EXPECT_EQ(Plan::make(config).recipe.radiance_filter.taps, 9);
  EXPECT_EQ(Plan::make(config).recipe.visibility_filter.taps, 9);
  EXPECT_EQ(Plan::make(config).recipe.radiance_filter.levels, levels - 1);
  config.more_levels = -3;
  EXPECT_EQ(Plan::make(config).recipe.radiance_filter.levels, 1);
}

TEST(Preset, WrongChoicesAreRefusedByName) {
  const auto refuses = [](const auto& spoil, const char* subject, const char* rule,
                          const char* value) {
    DenoiserConfig config = config_of("balanced");
    spoil(config);
    test::expect_input_error([&] { Denoiser denoiser(config); }, subject, rule, value);
  };
  refuses([](DenoiserConfig& c) { c.preset = "slow"; }, "preset",
          "fast, balanced, accurate, reference", "'slow'");
  refuses([](DenoiserConfig& c) { c.indirect_basis = "sh"; }, "indirect basis",
          "irradiance, luminance-cones, cones", "'sh'");
  refuses([](DenoiserConfig& c) { c.half_resolution = {"shadow"}; }, "half resolution",
          "indirect, glossy, visibility or none", "'shadow'");
  refuses([](DenoiserConfig& c) { c.kernel_taps = 3; }, "kernel taps", "9, 13 or 25", "3");
  refuses([](DenoiserConfig& c) { c.more_levels = 2; }, "more levels", "-3..1", "2");
  refuses(
      [](DenoiserConfig& c) {
        c.half_resolution = {"glossy", "glossy"};
      },
      "half resolution of glossy", "once", "twice");
  refuses(
      [](DenoiserConfig& c) {
        c.half_resolution = {"glossy", "none"};
      },
      "half resolution of none", "alone", "beside");
  refuses(
      [](DenoiserConfig& c) {
        c.indirect_basis = "cones";
        std::erase(c.planes, PlaneId{PlaneKind::kIndirectDirection, {}});
      },
      "indirect basis", "irradiance without plane", "'cones'");
}

TEST(Preset, AConstantImageIsAFixedPointAtEverySizeAndPreset) {
  for (const std::string& preset : preset_names())
    for (const auto& [width, height] : {std::pair{1, 1}, {1, 7}, {5, 3}, {20, 11}}) {
      const DenoiserConfig config = config_of(preset, width, height);
      Denoiser denoiser(config);
      for (int index = 0; index < 3; ++index) {
        Frame frame = test::noisy_frame(config, index);
        for (const PlaneId id : {test::kIndirectPlane, test::kGlossyPlane})
          for (int c = 0; c < 3; ++c) test::fill(frame.planes.find(id)->channel(c), 0.5f);
        const PlaneSet out = test::filtered(denoiser, frame);
        for (const PlaneId id : {test::kIndirectPlane, test::kGlossyPlane})
          for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
              ASSERT_NEAR(out.at(id).channel(1).at(x, y), 0.5f, 1e-4f)
                  << preset << ' ' << plane_name(id) << ' ' << width << 'x' << height;
      }
    }
}

TEST(Preset, HalfResolutionGoesWithEveryRecipeAndBasis) {
  for (const std::string& recipe : recipe_names())
    for (const char* basis : {"irradiance", "luminance-cones", "cones"}) {
      DenoiserConfig config = config_of("fast");
      config.recipe = recipe;
      config.indirect_basis = basis;
      config.debug_planes = true;
      for (const Plane& plane : last_of(config, 3))
        for (int c = 0; !plane.is_uint() && c < plane.channels(); ++c)
          for (int y = 0; y < plane.height(); ++y)
            for (int x = 0; x < plane.width(); ++x)
              ASSERT_TRUE(std::isfinite(plane.channel(c).at(x, y)))
                  << recipe << ' ' << basis << ' ' << plane_name(plane.id());
    }
}

TEST(Preset, HalfResolutionHoldsLessAndSaysSo) {
  DenoiserConfig config = config_of("balanced");
  const Denoiser whole(config);
  config.half_resolution = {"indirect", "glossy", "visibility"};
  const Denoiser half(config);
  EXPECT_LT(half.memory_bytes(), whole.memory_bytes());
  EXPECT_EQ(whole.plan_text().find("half resolution"), std::string::npos);
  EXPECT_NE(half.plan_text().find("indirect: at half resolution"), std::string::npos);
  EXPECT_NE(half.plan_text().find("glossy: at half resolution"), std::string::npos);
  EXPECT_NE(half.plan_text().find("light0.visibility: at half resolution"), std::string::npos);
}

TEST(Preset, ThePlanSaysWhatPassesMoveAndBuffersHold) {
  const std::string text = Denoiser(config_of("fast")).plan_text();
  EXPECT_EQ(text.rfind("recipe reliable\npreset fast\n", 0), 0u) << text;
  EXPECT_NE(text.find("levels of 9 taps, "), std::string::npos) << text;
  EXPECT_NE(text.find("all that is borrowed for a frame: "), std::string::npos) << text;
  EXPECT_NE(text.find("kept of light0.visibility as f32: "), std::string::npos) << text;
  // A quarter of the pixels, thus of the bytes.
  DenoiserConfig whole = config_of("fast");
  whole.half_resolution = {"none"};
  EXPECT_NE(text.find("indirect: local statistics, 31 B/pixel"), std::string::npos) << text;
  EXPECT_NE(Denoiser(whole).plan_text().find("indirect: local statistics, 124 B/pixel"),
            std::string::npos);
}

// Nothing of a component of one object may show on another, whose light is a hundred times larger.
TEST(Preset, HalfResolutionKeepsTheEdgesOfObjects) {
  for (const char* name : {"none", "indirect"}) {
    DenoiserConfig config = config_of("fast", 148, 116);
    config.half_resolution = {name};
    Denoiser denoiser(config);
    for (int index = 0; index < 4; ++index) {
      Frame frame = test::noisy_frame(config, index);
      const Plane& ids = frame.planes.at(test::kIdPlane);
      Plane& indirect = *frame.planes.find(test::kIndirectPlane);
      for (int c = 0; c < 3; ++c)
        for (int y = 0; y < config.height; ++y)
          for (int x = 0; x < config.width; ++x)
            indirect.channel(c).at(x, y) = ids.ids().at(x, y) == 2 ? 100.0f : 1.0f;
      const PlaneSet out = test::filtered(denoiser, frame);
      for (int y = 3; y < config.height; ++y)
        for (int x = 0; x < config.width; ++x)
          ASSERT_NEAR(out.at(test::kIndirectPlane).channel(0).at(x, y),
                      ids.ids().at(x, y) == 2 ? 100.0f : 1.0f,
                      ids.ids().at(x, y) == 2 ? 1.0f : 0.01f)
              << name << " frame " << index << " at " << x << ", " << y;
    }
  }
}

}  // namespace
}  // namespace holdfast
