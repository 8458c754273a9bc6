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

}  // namespace
}  // namespace holdfast
