// Gradient samples through the whole pipeline.

#include <cmath>

#include <gtest/gtest.h>

#include "core/frame/plane_size.h"
#include "tests/core/denoiser_world.h"
#include "tests/core/expect_input_error.h"

namespace holdfast {
namespace {

constexpr PlaneId kGradient{PlaneKind::kGradient, {ComponentKind::kIndirect, 0}};
constexpr int kWidth = 64, kHeight = 40;

DenoiserConfig config_of(const char* recipe, bool with_gradients = true) {
  DenoiserConfig config;
  config.width = kWidth;
  config.height = kHeight;
  config.recipe = recipe;
  config.planes = {test::kDepthPlane, test::kNormalPlane, test::kIndirectPlane};
  if (with_gradients) config.planes.push_back(kGradient);
  return config;
}

/// Light on the wall: on the left half a lamp goes on in frame 8.
float light_at(int x, std::int64_t index) {
  return x >= kWidth / 2 ? 1.0f : index < 8 ? 0.1f : 3.0f;
}

/// A still wall under that light, with noise in the samples and the same noise in both sides of the
/// gradients.
Frame lit_frame(const DenoiserConfig& config, std::int64_t index, bool changes) {
  Frame frame;
  frame.index = index;
  frame.camera = test::perspective_camera(kWidth, kHeight);
  test::Random random(77u + static_cast<std::uint32_t>(index));
  for (const PlaneId id : config.planes) {
    const PlaneSize size = plane_size(id, kWidth, kHeight);
    Plane& plane = frame.planes.add(id, size.width, size.height);
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x) {
        const float noise = random.real(0.0f, 2.0f);
        const std::int64_t before = changes ? index - 1 : 0, now = changes ? index : 0;
        if (id == test::kDepthPlane) plane.channel(0).at(x, y) = 4.0f;
        if (id == test::kNormalPlane) plane.channel(2).at(x, y) = 1.0f;
        if (id == test::kIndirectPlane)
          for (int c = 0; c < 3; ++c) plane.channel(c).at(x, y) = noise * light_at(x, now);
        if (id == kGradient && index > 0) {
          plane.channel(0).at(x, y) = noise * light_at(kStratum * x + 1, now);
          plane.channel(1).at(x, y) = noise * light_at(kStratum * x + 1, before);
        }
      }
  }
  return frame;
}

/// RMSE of the indirect light over the wall in frame `last`.
double error_after(const char* recipe, std::int64_t last) {
  const DenoiserConfig config = config_of(recipe);
  Denoiser denoiser(config);
  PlaneSet results;
  for (std::int64_t i = 0; i <= last; ++i) denoiser.filter(lit_frame(config, i, true), results);
  double sum = 0;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const float found = results.at(test::kIndirectPlane).channel(1).at(x, y);
      sum += std::pow(double(found - light_at(x, last)), 2);
    }
  return std::sqrt(sum / (kWidth * kHeight));
}

TEST(Asvgf, ErrsFarLessThanSvgfRightAfterTheLightChanges) {
  EXPECT_LT(error_after("asvgf", 8), 0.35 * error_after("svgf", 8));
  EXPECT_LT(error_after("asvgf", 9), 0.5 * error_after("svgf", 9));
}

TEST(Asvgf, EqualsSvgfWhereNothingChanges) {
  const DenoiserConfig a = config_of("asvgf"), b = config_of("svgf");
  Denoiser adaptive(a), fixed(b);
  for (std::int64_t i = 0; i < 12; ++i) {
    const Frame frame = lit_frame(a, i, false);
    EXPECT_TRUE(test::same_bits(test::filtered(adaptive, frame), test::filtered(fixed, frame)));
  }
}

TEST(Asvgf, WithoutGradientPlanesBehavesAsSvgfAndSaysSo) {
  const DenoiserConfig a = config_of("asvgf", false), b = config_of("svgf", false);
  Denoiser adaptive(a), fixed(b);
  EXPECT_NE(adaptive.plan_text().find("indirect: no gradient samples"), std::string::npos);
  EXPECT_NE(Denoiser(config_of("asvgf")).plan_text().find("indirect: history replaced sooner"),
            std::string::npos);
  for (std::int64_t i = 0; i < 12; ++i) {
    const Frame frame = lit_frame(a, i, true);
    EXPECT_TRUE(test::same_bits(test::filtered(adaptive, frame), test::filtered(fixed, frame)));
  }
}

TEST(GradientPlanes, ChangeNothingUnderRecipesThatDoNotUseThem) {
  for (const std::string& recipe : recipe_names()) {
    if (recipe_uses(recipe, PlaneKind::kGradient)) continue;
    SCOPED_TRACE(recipe);
    const DenoiserConfig with = config_of(recipe.c_str()),
                         without = config_of(recipe.c_str(), false);
    Denoiser a(with), b(without);
    EXPECT_EQ(a.plan_text(), b.plan_text());
    EXPECT_EQ(a.memory_bytes(), b.memory_bytes());
    for (std::int64_t i = 6; i < 10; ++i)
      EXPECT_TRUE(test::same_bits(test::filtered(a, lit_frame(with, i, true)),
                                  test::filtered(b, lit_frame(without, i, true))));
  }
}

TEST(GradientPlanes, AreUsedByTheAdaptiveRecipesAlone) {
  for (const std::string& recipe : recipe_names()) {
    EXPECT_EQ(recipe_uses(recipe, PlaneKind::kGradient),
              recipe == "asvgf" || recipe == "paper-adaptive");
    EXPECT_TRUE(recipe_uses(recipe, PlaneKind::kDepth));
  }
  EXPECT_FALSE(recipe_uses("magic", PlaneKind::kGradient));
}

TEST(GradientPlanes, OfAnotherSizeAreRefusedByName) {
  const DenoiserConfig config = config_of("asvgf");
  Denoiser denoiser(config);
  Frame frame = lit_frame(config, 0, true);
  frame.planes.add(kGradient, kWidth, kHeight);
  PlaneSet results;
  test::expect_input_error([&] { denoiser.filter(frame, results); }, "plane gradient.indirect",
                           "must be 22x14", "64x40");
}

TEST(GradientPlanes, MustBelongToAComponentOfTheSession) {
  DenoiserConfig config = config_of("asvgf");
  config.planes.push_back({PlaneKind::kGradient, {ComponentKind::kGlossy, 0}});
  test::expect_input_error([&] { Denoiser denoiser(config); }, "plane gradient.glossy",
                           "component of the session", "of glossy");
}

TEST(GradientPlanes, WithValuesThatAreNoRadianceAreRepairedAndReported) {
  const DenoiserConfig config = config_of("asvgf");
  Denoiser denoiser(config);
  PlaneSet results;
  denoiser.filter(lit_frame(config, 0, true), results);
  Frame frame = lit_frame(config, 1, true);
  frame.planes.find(kGradient)->channel(1).at(3, 3) = test::kNaN;
  const FrameReport report = denoiser.filter(frame, results);
  ASSERT_EQ(report.repaired.size(), 1u);
  EXPECT_EQ(report.repaired[0].plane, kGradient);
  EXPECT_EQ(report.repaired[0].values, 1u);
  EXPECT_EQ(report.non_finite_out, 0u);
}

}  // namespace
}  // namespace holdfast
