#include "client/measure/claims.h"

#include <cmath>
#include <map>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "client/measure/claims_text.h"

namespace holdfast::measure {
namespace {

/// RMSE and SSIM of one recipe, the same on both masks.
struct Figures {
  double rmse, ssim;
};
using Recipes = std::vector<std::pair<std::string, Figures>>;

ReportScene scene_of(const std::string& name, const std::string& layer, const Recipes& recipes,
                     std::int64_t effect_pixels = 10) {
  ReportScene scene{name, "", "", {}};
  for (const auto& [recipe, figures] : recipes) {
    LayerErrors errors;
    errors.rmse = figures.rmse;
    errors.ssim = figures.ssim;
    errors.judged_pixels = 100;
    Comparison::Layer compared{layer, Measure::kClip, errors, errors};
    compared.effect.judged_pixels = effect_pixels;
    ReportResult result{recipe, "", {}};
    result.comparison.layers = {compared};
    scene.results.push_back(result);
  }
  return scene;
}

std::vector<Claim> of_effect(const std::vector<Claim>& claims, const std::string& effect) {
  std::vector<Claim> chosen;
  for (const Claim& claim : claims)
    if (claim.effect == effect) chosen.push_back(claim);
  return chosen;
}

const Claim& against(const std::vector<Claim>& claims, const std::string& recipe,
                     Metric metric = Metric::kRmse) {
  for (const Claim& claim : claims)
    if (claim.against == recipe && claim.metric == metric) return claim;
  throw std::runtime_error("no claim against " + recipe);
}

TEST(Claims, ShadowsHoldAtTheirBarsAndFailAboveThem) {
  const Recipes at_the_bars{{"clamp", {1.0, 0.5}},
                            {"svgf", {1.4, 0.6}},
                            {"asvgf", {0.85, 0.7}},
                            {"reliable", {0.84, 0.7}}};
  const auto holds =
      of_effect(evaluate_claims({scene_of("fence", "light0.visibility", at_the_bars)}), "shadows");
  ASSERT_EQ(holds.size(), 4u);
  for (const Claim& claim : holds) EXPECT_EQ(claim.outcome, Outcome::kHolds) << claim.against;
  EXPECT_DOUBLE_EQ(against(holds, "svgf").value, 0.6);
  EXPECT_EQ(against(holds, kAllOthers, Metric::kSsim).value, 1.0) << "the best other is asvgf";

  const Recipes beyond{{"clamp", {1.0, 0.5}},
                       {"svgf", {1.4, 0.6}},
                       {"asvgf", {0.845, 0.71}},
                       {"reliable", {0.845, 0.7}}};
  const auto fails =
      of_effect(evaluate_claims({scene_of("cylinder", "light1.visibility", beyond)}), "shadows");
  ASSERT_EQ(fails.size(), 4u);
  for (const Claim& claim : fails) EXPECT_EQ(claim.outcome, Outcome::kFails) << claim.against;
}

TEST(Claims, EachEffectIsJudgedOnItsOwnScenesAndComponentWithItsOwnBars) {
  const Recipes recipes{{"traditional", {1, 0.5}}, {"clamp", {1, 0.5}}, {"svgf", {1, 0.5}},
                        {"specular", {1, 0.5}},    {"asvgf", {1, 0.5}}, {"reliable", {0.5, 0.6}}};
  const auto glossy =
      of_effect(evaluate_claims({scene_of("glossy-floor", "glossy", recipes)}), "glossy");
  ASSERT_EQ(glossy.size(), 4u);
  EXPECT_EQ(against(glossy, "specular").bar, 0.98);
  EXPECT_EQ(against(glossy, "asvgf").bar, 0.54);
  EXPECT_EQ(against(glossy, "clamp").bar, 0.50);
  EXPECT_EQ(against(glossy, "clamp").outcome, Outcome::kHolds);

  const auto occlusion =
      of_effect(evaluate_claims({scene_of("occluder", "indirect", recipes)}), "occlusion");
  ASSERT_EQ(occlusion.size(), 4u);
  EXPECT_EQ(against(occlusion, "clamp").bar, 0.98);
  EXPECT_EQ(against(occlusion, "svgf").bar, 0.91);
  EXPECT_EQ(against(occlusion, "traditional").bar, 0.29);
  EXPECT_EQ(against(occlusion, "traditional").outcome, Outcome::kFails);

  // Other components and scenes have the claims of every scene only.
  for (const auto& scene :
       {scene_of("glossy-floor", "indirect", recipes), scene_of("room", "glossy", recipes)})
    for (const Claim& claim : evaluate_claims({scene})) EXPECT_EQ(claim.effect, kEverywhere);
}

TEST(Claims, EverywhereToleratesHalfAPercentOnEitherMask) {
  const auto claims_with = [](Figures ours) {
    return of_effect(evaluate_claims({scene_of("room", "indirect",
                                               {{"spatial", {1, 0.8}},
                                                {"clamp", {1, 0.8}},
                                                {"paper", {1, 0.8}},
                                                {"reliable", ours}})}),
                     kEverywhere);
  };
  const auto holds = claims_with({1.0049, 0.7961});
  ASSERT_EQ(holds.size(), 12u) << "two masks, three recipes, RMSE and SSIM";
  EXPECT_EQ(count_claims(holds).holds, 12);
  EXPECT_EQ(count_claims(claims_with({1.0051, 0.7961})).fails, 6);
  EXPECT_EQ(count_claims(claims_with({1.0049, 0.7959})).fails, 6);
}

TEST(Claims, AStillSceneStaysWithinOnePercentOfSvgfOnTheWholeImage) {
  const auto claims_with = [](Figures ours) {
    return of_effect(evaluate_claims({scene_of("static", "glossy",
                                               {{"svgf", {1, 0.8}}, {"reliable", ours}}, 0)}),
                     "still scene");
  };
  ASSERT_EQ(claims_with({1.01, 0.8}).size(), 2u);
  EXPECT_EQ(count_claims(claims_with({1.01, 0.792})).holds, 2);
  EXPECT_EQ(count_claims(claims_with({1.011, 0.791})).fails, 2);
  EXPECT_EQ(claims_with({1, 0.8}).front().region, Region::kImage);
}

TEST(Claims, AMissingRecipeIsNotRunAndAnEmptyMaskHasNoClaim) {
  const auto claims = evaluate_claims(
      {scene_of("fence", "light0.visibility", {{"clamp", {1, 0.5}}, {"reliable", {0.5, 0.6}}}, 0)});
  EXPECT_TRUE(of_effect(claims, "shadows").empty()) << "no effect pixel";
  const ClaimCount count = count_claims(claims);
  EXPECT_EQ(count.holds, 2);
  EXPECT_EQ(count.not_run, 4) << "spatial and paper over the image";
  for (const auto& row : claims_json(claims))
    EXPECT_EQ(row["value"].is_null() && row["pass"].is_null(), row["against"] != "clamp");

  const auto without_ours =
      evaluate_claims({scene_of("fence", "light0.visibility", {{"clamp", {1, 0.5}}})});
  EXPECT_EQ(count_claims(without_ours).not_run, static_cast<int>(without_ours.size()));
  EXPECT_FALSE(without_ours.empty());
}

TEST(Claims, VariantsOfReliableAreNotAmongTheOthers) {
  const auto claims =
      of_effect(evaluate_claims({scene_of("fence", "light0.visibility",
                                          {{"clamp", {1, 0.5}},
                                           {"reliable", {0.5, 0.6}},
                                           {"reliable-without-borrowing", {0.4, 0.7}}})}),
                "shadows");
  EXPECT_EQ(against(claims, kAllOthers, Metric::kSsim).value, 0.6 / 0.5);
}

TEST(Claims, ZeroErrorsAndNegativeSimilarityAreCompared) {
  const auto claims = evaluate_claims({scene_of(
      "room", "glossy", {{"spatial", {0, -0.1}}, {"clamp", {0, 0.1}}, {"reliable", {0, 0.0}}})});
  EXPECT_EQ(against(claims, "spatial").outcome, Outcome::kHolds) << "both exact";
  EXPECT_EQ(against(claims, "spatial", Metric::kSsim).outcome, Outcome::kHolds);
  EXPECT_EQ(against(claims, "clamp", Metric::kSsim).outcome, Outcome::kFails);
  const auto worse =
      evaluate_claims({scene_of("room", "glossy", {{"spatial", {0, 1}}, {"reliable", {1e-3, 1}}})});
  EXPECT_EQ(against(worse, "spatial").outcome, Outcome::kFails) << "any error is more than none";
  EXPECT_TRUE(claims_json(worse)[0]["value"].is_null()) << "JSON has no infinity";
  EXPECT_EQ(claims_json(worse)[0]["pass"], false);
}

TEST(Claims, NoisyReferencesAreNoted) {
  ReportScene scene =
      scene_of("fence", "light0.visibility", {{"clamp", {0.2, 0.5}}, {"reliable", {0.1, 0.6}}});
  // Two references differ by sqrt(2) times the noise; the bar is a tenth of 0.1.
  scene.reference_noise = {{"light0.visibility", 0.00706, 0.00708}};
  for (const Claim& claim : evaluate_claims({scene}))
    EXPECT_EQ(claim.reference_limited,
              claim.region == Region::kEffect && claim.outcome != Outcome::kNotRun)
        << claim.against;
  EXPECT_NE(claims_html(evaluate_claims({scene})).find(kLimitedNote), std::string::npos);
}

TEST(Claims, ThePageListsSingleEffectsAndOnlyTheFailuresOfTheRest) {
  const auto claims = evaluate_claims(
      {scene_of("fence", "light0.visibility",
                {{"spatial", {0.09, 0.9}}, {"clamp", {0.2, 0.5}}, {"reliable", {0.1, 0.95}}})});
  const std::string html = claims_html(claims);
  EXPECT_NE(html.find("6 of 8 comparisons hold, 4 were not run"), std::string::npos) << html;
  EXPECT_EQ(listed_claims(claims).size(), 4u + 2u);
  EXPECT_NE(html.find("<td class=\"fails\">fails</td>"), std::string::npos);
  EXPECT_NE(html.find("not run"), std::string::npos);
}

}  // namespace
}  // namespace holdfast::measure
