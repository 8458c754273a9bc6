#include <algorithm>

#include <gtest/gtest.h>

#include "tests/core/denoiser_world.h"

namespace holdfast {
namespace {

// Fireflies that change colour and a shadow that sweeps: history is wrong by much, again and again.
TEST(Denoiser, ResultsStayInTheRangeOfTheirInputsUnderEveryRecipe) {
  for (const std::string& recipe : recipe_names()) {
    DenoiserConfig config = test::full_config(65, 41);
    config.recipe = recipe;
    Denoiser denoiser(config);
    float least = 0, most_visible = 1;
    for (int index = 0; index < 20; ++index) {
      Frame frame = test::noisy_frame(config, index);
      test::Random random(77u + static_cast<std::uint32_t>(index));
      for (int y = 0; y < 41; ++y)
        for (int x = 0; x < 65; ++x) {
          const float spark = random.uniform() < 0.03 ? 50.0f : 0.0f;
          for (int c = 0; c < 3; ++c)
            frame.planes.find(test::kGlossyPlane)->channel(c).at(x, y) =
                spark * (c == index % 3 ? 1.0f : 0.1f);
          const bool lit = ((x + 6 * index) / 12) % 2 == 1;
          frame.planes.find(test::of_light(PlaneKind::kVisibility))->channel(0).at(x, y) =
              random.uniform() < (lit ? 0.95 : 0.05) ? 1.0f : 0.0f;
        }
      const PlaneSet results = test::filtered(denoiser, frame);
      for (int y = 0; y < 41; ++y)
        for (int x = 0; x < 65; ++x) {
          for (const Plane& plane : results)
            for (int c = 0; c < plane.channels(); ++c)
              least = std::min(least, plane.channel(c).at(x, y));
          most_visible = std::max(
              most_visible, results.at(test::of_light(PlaneKind::kVisibility)).channel(0).at(x, y));
        }
    }
    EXPECT_GE(least, 0.0f) << recipe;
    EXPECT_LE(most_visible, 1.0f + 1e-5f) << recipe;
  }
}

// The light turns to a wall that it did not reach, and there the wall is in shadow: that it counted
// as visible before must not brighten the shadow.
TEST(Denoiser, WhereALightDidNotReachThereIsNoHistoryOfItsVisibility) {
  const PlaneId visibility = test::of_light(PlaneKind::kVisibility);
  const PlaneId unshadowed = test::of_light(PlaneKind::kUnshadowed);
  for (const char* recipe : {"spatial", "paper", "paper-adaptive", "reliable"}) {
    DenoiserConfig config = test::full_config();
    config.recipe = recipe;
    Denoiser denoiser(config);
    PlaneSet results;
    for (int index = 0; index < 6; ++index) {
      Frame frame = test::noisy_frame(config, index);
      const bool reached = index == 5;
      test::fill(frame.planes.find(visibility)->channel(0), reached ? 0.0f : 1.0f);
      for (int c = 0; c < 3; ++c)
        test::fill(frame.planes.find(unshadowed)->channel(c), reached ? 1.0f : 0.0f);
      denoiser.filter(frame, results);
    }
    for (int y = 3; y < config.height; ++y)
      for (int x = 0; x < config.width; ++x)
        ASSERT_EQ(results.at(visibility).channel(0).at(x, y), 0.0f)
            << recipe << " at " << x << ", " << y;
  }
}

TEST(Denoiser, WhatIsSentWhereALightDoesNotReachStaysThereAndDoesNotBrightenShadows) {
  const PlaneId visibility = test::of_light(PlaneKind::kVisibility);
  const PlaneId unshadowed = test::of_light(PlaneKind::kUnshadowed);
  for (const char* recipe : {"spatial", "paper", "paper-adaptive", "reliable"}) {
    DenoiserConfig config = test::full_config();
    config.recipe = recipe;
    Denoiser denoiser(config);
    PlaneSet results;
    const auto reached = [&](int x) { return x < config.width / 2; };
    for (int index = 0; index < 6; ++index) {
      Frame frame = test::noisy_frame(config, index);
      for (int y = 0; y < config.height; ++y)
        for (int x = 0; x < config.width; ++x) {
          frame.planes.find(visibility)->channel(0).at(x, y) = reached(x) ? 0.0f : 1.0f;
          for (int c = 0; c < 3; ++c)
            frame.planes.find(unshadowed)->channel(c).at(x, y) = reached(x) ? 1.0f : 0.0f;
        }
      denoiser.filter(frame, results);
    }
    float brightest = 0;
    for (int y = 3; y < config.height; ++y)
      for (int x = 0; x < config.width; ++x) {
        const float result = results.at(visibility).channel(0).at(x, y);
        if (reached(x))
          brightest = std::max(brightest, result);
        else
          ASSERT_EQ(result, 1.0f) << recipe << " at " << x << ", " << y;
      }
    EXPECT_LT(brightest, 0.03f) << recipe;
  }
}

TEST(Denoiser, ForeignPlanesAmongTheResultsDoNotEnterTheComposite) {
  const DenoiserConfig full = test::full_config(), shadow = test::shadow_config();
  Denoiser first(full), second(shadow), fresh(shadow);
  PlaneSet results;
  first.filter(test::noisy_frame(full, 0), results);
  second.filter(test::noisy_frame(shadow, 0), results);
  const PlaneSet expected = test::filtered(fresh, test::noisy_frame(shadow, 0));
  EXPECT_LE(test::largest_difference(expected, results), 0.0);
}

TEST(Denoiser, FiniteFactorsGiveAFiniteComposite) {
  const DenoiserConfig config = test::full_config();
  Denoiser denoiser(config);
  Frame frame = test::noisy_frame(config, 0);
  test::fill(frame.planes.find({PlaneKind::kSpecular, {}})->channel(0), 3e38f);
  test::fill(frame.planes.find(test::kGlossyPlane)->channel(0), 50.0f);
  PlaneSet results;
  EXPECT_EQ(denoiser.filter(frame, results).non_finite_out, 0u);
}

}  // namespace
}  // namespace holdfast
