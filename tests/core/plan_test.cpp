#include "core/denoiser/plan.h"

#include <gtest/gtest.h>

#include "tests/core/denoiser_world.h"

namespace holdfast {
namespace {

TEST(Plan, ListsOnlyWhatTheSessionsPlanesNeed) {
  const std::string full = Denoiser(test::full_config()).plan_text();
  EXPECT_NE(full.find("glossy: "), std::string::npos);
  EXPECT_NE(full.find("indirect: "), std::string::npos);
  EXPECT_NE(full.find("light7.visibility: history along surface vectors"), std::string::npos);
  EXPECT_NE(full.find("light0.visibility: history along shadow and surface"), std::string::npos);
  const std::string shadow = Denoiser(test::shadow_config()).plan_text();
  EXPECT_EQ(shadow.find("glossy"), std::string::npos);
  EXPECT_EQ(shadow.find("indirect"), std::string::npos);
}

TEST(Plan, OfTheSpatialRecipeHasNoHistory) {
  DenoiserConfig config = test::full_config();
  config.recipe = "spatial";
  EXPECT_EQ(Denoiser(config).plan_text().find("history"), std::string::npos);
}

TEST(Plan, WithoutBlockersFollowsTheSurface) {
  DenoiserConfig config = test::shadow_config();
  std::erase(config.planes, test::of_light(PlaneKind::kLightSample));
  EXPECT_EQ(Denoiser(config).plan_text().find("shadow"), std::string::npos);
}

TEST(Plan, EveryRecipeIsNamedInItsText) {
  for (const std::string& recipe : recipe_names()) {
    DenoiserConfig config = test::full_config();
    config.recipe = recipe;
    EXPECT_EQ(Denoiser(config).plan_text().rfind("recipe " + recipe + "\n", 0), 0u);
  }
}

TEST(Plan, FewerComponentsHoldLessMemory) {
  EXPECT_LT(Denoiser(test::shadow_config()).memory_bytes(),
            Denoiser(test::full_config()).memory_bytes());
  DenoiserConfig debugging = test::full_config();
  debugging.debug_planes = true;
  EXPECT_LT(Denoiser(test::full_config()).memory_bytes(), Denoiser(debugging).memory_bytes());
}

DenoiserConfig with_hits(bool roughness) {
  DenoiserConfig config = test::full_config();
  config.planes.push_back({PlaneKind::kGlossyDirection, {}});
  config.planes.push_back({PlaneKind::kGlossyHitDistance, {}});
  if (roughness) config.planes.push_back({PlaneKind::kRoughness, {}});
  return config;
}

TEST(Plan, FollowsReflectionsOnlyWithTheirHits) {
  const std::string along = "glossy: history along ";
  EXPECT_NE(Denoiser(with_hits(true)).plan_text().find(along + "reflection and surface vectors"),
            std::string::npos);
  EXPECT_NE(Denoiser(test::full_config()).plan_text().find(along + "surface vectors"),
            std::string::npos);
  DenoiserConfig config = with_hits(true);
  std::erase(config.planes, PlaneId{PlaneKind::kGlossyDirection, {}});
  EXPECT_NE(Denoiser(config).plan_text().find(along + "surface vectors"), std::string::npos);
  for (const char* recipe : {"spatial", "traditional", "clamp", "svgf"}) {
    config = with_hits(true);
    config.recipe = recipe;
    EXPECT_EQ(Denoiser(config).plan_text().find("reflection"), std::string::npos) << recipe;
  }
  for (const char* recipe : {"specular", "specular-clamp", "paper", "reliable"}) {
    config = with_hits(true);
    config.recipe = recipe;
    EXPECT_NE(Denoiser(config).plan_text().find("reflection"), std::string::npos) << recipe;
  }
}

TEST(Plan, MeasuresLobesOnlyWithHitsAndRoughness) {
  EXPECT_NE(Denoiser(with_hits(true)).plan_text().find("glossy: local statistics, lobe footprint"),
            std::string::npos);
  EXPECT_EQ(Denoiser(with_hits(false)).plan_text().find("lobe"), std::string::npos);
  EXPECT_EQ(Denoiser(test::full_config()).plan_text().find("lobe"), std::string::npos);
}

TEST(Plan, FollowsDisocclusionsOfIndirectLight) {
  const std::string dual = "indirect: history along surface and, where it was hidden, dual vectors";
  DenoiserConfig config = test::full_config();
  EXPECT_NE(Denoiser(config).plan_text().find(dual), std::string::npos);
  config.recipe = "traditional";
  EXPECT_EQ(Denoiser(config).plan_text().find("dual"), std::string::npos);
  config = test::full_config();
  std::erase(config.planes, test::kIndirectPlane);
  EXPECT_EQ(Denoiser(config).plan_text().find("dual"), std::string::npos);
}

// The planes of hits and roughness say nothing without reflected radiance.
TEST(Plan, WithoutGlossyRadianceNothingOfItIsHeldOrRun) {
  for (const std::string& recipe : recipe_names()) {
    DenoiserConfig config = with_hits(true);
    config.recipe = recipe;
    const std::size_t with_glossy = Denoiser(config).memory_bytes();
    std::erase(config.planes, test::kGlossyPlane);
    const Denoiser without(config);
    EXPECT_LT(without.memory_bytes(), with_glossy) << recipe;
    for (const char* pass : {"glossy", "reflection", "lobe"})
      EXPECT_EQ(without.plan_text().find(pass), std::string::npos) << recipe << ' ' << pass;
    for (const PlaneKind kind :
         {PlaneKind::kGlossyDirection, PlaneKind::kGlossyHitDistance, PlaneKind::kRoughness})
      std::erase(config.planes, PlaneId{kind, {}});
    EXPECT_EQ(Denoiser(config).memory_bytes(), without.memory_bytes())
        << recipe << " holds a buffer for glossy planes";
    EXPECT_EQ(Denoiser(config).plan_text(), without.plan_text()) << recipe;
  }
}

TEST(Plan, WithoutGlossyRadianceNoStageOfItIsTimed) {
  DenoiserConfig config = with_hits(true);
  std::erase(config.planes, test::kGlossyPlane);
  Denoiser denoiser(config);
  for (int index = 0; index < 2; ++index) {
    PlaneSet results;
    for (const auto& stage : denoiser.filter(test::noisy_frame(config, index), results).stages)
      EXPECT_EQ(stage.stage.find("glossy"), std::string::npos) << stage.stage;
  }
}

}  // namespace
}  // namespace holdfast
