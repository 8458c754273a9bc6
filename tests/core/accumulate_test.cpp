#include "core/history/accumulate.h"

#include <gtest/gtest.h>

#include "tests/core/history_world.h"

namespace holdfast {
namespace {

using test::StillHistory;

TEST(Accumulate, BlendsByAlphaOnceHistoryIsLong) {
  StillHistory h(3, 2, 1);
  test::fill(h.noisy[0], 1.0f);
  test::fill(h.before.data[0], 0.0f);
  test::fill(h.before.samples(), 50.0f);
  accumulate(h.guides, h.noisy, h.by_surface(), {.alpha = 0.2f}, h.before, h.now, nullptr);
  EXPECT_NEAR(h.now.data[0].at(1, 1), 0.2f, 1e-6f);
}

TEST(Accumulate, SignalMayGoElsewhere) {
  StillHistory h(3, 2, 1);
  test::fill(h.noisy[0], 1.0f);
  test::fill(h.before.data[0], 0.0f);
  test::fill(h.before.samples(), 50.0f);
  test::fill(h.now.data[0], 7.0f);
  Channels<float> signal(3, 2, 1);
  accumulate(h.guides, h.noisy, h.by_surface(), {.alpha = 0.2f}, h.before, h.now, signal, nullptr);
  EXPECT_NEAR(signal[0].at(1, 1), 0.2f, 1e-6f);
  EXPECT_EQ(h.now.data[0].at(1, 1), 7.0f);
  EXPECT_NEAR(h.now.samples().at(1, 1), 9.0f, 1e-5f) << "which the history keeps all the same";
}

TEST(Accumulate, YoungHistoryIsAPlainMean) {
  StillHistory h(2, 2, 1);
  accumulate(h.guides, h.noisy, {}, {}, h.before, h.now, nullptr);
  const float values[] = {1.0f, 0.0f, 0.5f, 0.25f, 1.0f};
  float sum = 0;
  for (int k = 0; k < 5; ++k) {
    test::fill(h.noisy[0], values[k]);
    sum += values[k];
    std::swap(h.before, h.now);
    accumulate(h.guides, h.noisy, k == 0 ? HistorySources{} : h.by_surface(), {.alpha = 0.1f},
               h.before, h.now, nullptr);
    EXPECT_NEAR(h.now.data[0].at(0, 1), sum / static_cast<float>(k + 1), 1e-6f);
    EXPECT_EQ(h.now.samples().at(0, 1), static_cast<float>(k + 1));
  }
}

TEST(Accumulate, SamplesLevelOffAtThoseOfAnExponentialMean) {
  StillHistory h(1, 1, 1);
  for (int k = 0; k < 100; ++k) {
    accumulate(h.guides, h.noisy, h.by_surface(), {.alpha = 0.2f}, h.before, h.now, nullptr);
    std::swap(h.before, h.now);
  }
  EXPECT_FLOAT_EQ(h.before.samples().at(0, 0), 9.0f);  // (2 - 0.2) / 0.2
}

TEST(Accumulate, AlphaOfZeroIsThePlainMeanHoweverLong) {
  StillHistory h(1, 1, 1);
  accumulate(h.guides, h.noisy, {}, {.alpha = 0.0f}, h.before, h.now, nullptr);
  for (int k = 1; k < 2000; ++k) {
    std::swap(h.before, h.now);
    h.noisy[0].at(0, 0) = static_cast<float>(k % 2);
    accumulate(h.guides, h.noisy, h.by_surface(), {.alpha = 0.0f}, h.before, h.now, nullptr);
  }
  EXPECT_NEAR(h.now.data[0].at(0, 0), 0.5f, 1e-4f);
  EXPECT_NEAR(h.now.samples().at(0, 0), 2000.0f, 1.0f);
}

TEST(Accumulate, AlphaOfOneIsTheCurrentFrame) {
  StillHistory h(2, 1, 1);
  test::fill(h.before.data[0], 1e15f);
  test::fill(h.before.samples(), 50.0f);
  test::fill(h.noisy[0], 0.25f);
  accumulate(h.guides, h.noisy, h.by_surface(), {.alpha = 1.0f}, h.before, h.now, nullptr);
  EXPECT_EQ(h.now.data[0].at(1, 0), 0.25f);
  EXPECT_EQ(h.now.samples().at(1, 0), 1.0f);
}

TEST(Accumulate, WithoutHistoryTheCurrentFramePasses) {
  StillHistory h(2, 1, 3);
  test::fill(h.before.data[0], 9.0f);
  for (int c = 0; c < 3; ++c) test::fill(h.noisy[c], 0.1f * static_cast<float>(c + 1));
  h.surface.taps[0].at(1, 0) = {};
  accumulate(h.guides, h.noisy, h.by_surface(), {}, h.before, h.now, nullptr);
  for (int c = 0; c < 3; ++c) {
    EXPECT_EQ(h.now.data[c].at(1, 0), h.noisy[c].at(1, 0));
    EXPECT_NE(h.now.data[0].at(0, 0), h.noisy[0].at(0, 0));
  }
  EXPECT_EQ(h.now.samples().at(1, 0), 1.0f);
}

TEST(Accumulate, TrustInAShadowVectorScalesHistory) {
  StillHistory h(4, 1, 1);
  test::fill(h.noisy[0], 1.0f);
  h.before.data[0].at(3, 0) = 0.5f;  // where the shadow was
  test::fill(h.before.samples(), 3.0f);
  h.follow_shadow(0, 0, 3, 0, 1.0f);
  h.follow_shadow(1, 0, 3, 0, 0.4f);
  h.follow_shadow(2, 0, 3, 0, 0.0f);
  accumulate(h.guides, h.noisy, h.by_effect(), {.alpha = 0.1f}, h.before, h.now, nullptr);
  // a = 1/(3+1), a' = 1 - trust 3/4
  EXPECT_NEAR(h.now.data[0].at(0, 0), 0.25f + 0.75f * 0.5f, 1e-6f);
  EXPECT_NEAR(h.now.data[0].at(1, 0), 0.7f + 0.3f * 0.5f, 1e-6f);
  EXPECT_EQ(h.now.data[0].at(2, 0), 1.0f);
  EXPECT_EQ(h.now.samples().at(0, 0), 4.0f);
  EXPECT_EQ(h.now.samples().at(2, 0), 1.0f);
  EXPECT_NEAR(h.now.data[0].at(3, 0), 0.25f + 0.75f * 0.5f, 1e-6f) << "no shadow: by the surface";
}

TEST(Accumulate, WhatStandsInForTheSurfaceIsAnythingElsewhere) {
  StillHistory h(4, 1, 1);
  test::fill(h.noisy[0], 1.0f);
  test::fill(h.before.samples(), 3.0f);
  h.before.data[0].at(1, 0) = 0.5f;
  for (int x = 0; x < 4; ++x) h.follow_shadow(x, 0, 1, 0, test::kNaN);
  HistorySources sources = h.by_effect();
  sources.effect_stands_in = true;
  accumulate(h.guides, h.noisy, sources, {.alpha = 0.1f}, h.before, h.now, nullptr);
  EXPECT_NEAR(h.now.data[0].at(0, 0), 0.25f, 1e-6f) << "all follow the surface";
  h.surface.taps[0].at(2, 0) = h.surface.taps[0].at(3, 0) = {};
  for (const int x : {0, 1}) h.shadow.taps[0].at(x, 0) = {-1, {test::kNaN, 0, 0, test::kNaN}};
  h.shadow.taps[0].at(3, 0) = {};
  accumulate(h.guides, h.noisy, sources, {.alpha = 0.1f}, h.before, h.now, nullptr);
  EXPECT_NEAR(h.now.data[0].at(0, 0), 0.25f, 1e-6f);
  EXPECT_NEAR(h.now.data[0].at(2, 0), 0.25f + 0.75f * 0.5f, 1e-6f) << "with full trust";
  EXPECT_EQ(h.now.data[0].at(3, 0), 1.0f) << "a second failure";
}

/// A 3x3 of noisy values with mean 0.5 and standard deviation 0.1 about pixel (1, 1).
StillHistory noisy_neighbourhood(int channels) {
  StillHistory h(3, 3, channels);
  const float sigma = 0.1f * std::sqrt(9.0f / 8.0f);
  for (int c = 0; c < channels; ++c) {
    for (int k = 0; k < 9; ++k)
      h.noisy[c].at(k % 3, k / 3) = k == 4 ? 0.5f : (k % 2 == 0 ? 0.5f + sigma : 0.5f - sigma);
    test::fill(h.before.data[c], 5.0f);
  }
  test::fill(h.before.samples(), 100.0f);
  return h;
}

TEST(Accumulate, ClampsHistoryToMeanAndStandardDeviationsOfNineNeighbours) {
  StillHistory h = noisy_neighbourhood(1);
  const AccumulationRule rule{
      .alpha = 0.1f, .rectification = Rectification::kClamp, .clamp_gamma = 2.0f};
  accumulate(h.guides, h.noisy, h.by_surface(), rule, h.before, h.now, nullptr);
  EXPECT_NEAR(h.now.data[0].at(1, 1), 0.1f * 0.5f + 0.9f * 0.7f, 1e-5f);
}

TEST(Accumulate, ClampBoxClampsHistoryToLeastAndGreatestOfNineNeighbours) {
  StillHistory h = noisy_neighbourhood(1);
  h.noisy[0].at(2, 1) = 0.9f;
  h.noisy[0].at(0, 1) = 0.2f;
  const AccumulationRule rule{.alpha = 0.1f, .rectification = Rectification::kClampBox};
  accumulate(h.guides, h.noisy, h.by_surface(), rule, h.before, h.now, nullptr);
  EXPECT_NEAR(h.now.data[0].at(1, 1), 0.1f * 0.5f + 0.9f * 0.9f, 1e-6f);
  test::fill(h.before.data[0], 0.0f);
  accumulate(h.guides, h.noisy, h.by_surface(), rule, h.before, h.now, nullptr);
  EXPECT_NEAR(h.now.data[0].at(1, 1), 0.1f * 0.5f + 0.9f * 0.2f, 1e-6f);
  test::fill(h.before.data[0], 0.3f);
  accumulate(h.guides, h.noisy, h.by_surface(), rule, h.before, h.now, nullptr);
  EXPECT_NEAR(h.now.data[0].at(1, 1), 0.1f * 0.5f + 0.9f * 0.3f, 1e-6f) << "inside the box";
}

TEST(Accumulate, ClampBoxOfColoursActsInYCoCg) {
  StillHistory h = noisy_neighbourhood(3);  // grey: Co = Cg = 0 everywhere
  test::fill(h.before.data[0], 0.6f);
  test::fill(h.before.data[1], 0.5f);
  test::fill(h.before.data[2], 0.4f);
  const AccumulationRule rule{.alpha = 0.0f, .rectification = Rectification::kClampBox};
  accumulate(h.guides, h.noisy, h.by_surface(), rule, h.before, h.now, nullptr);
  for (int c = 0; c < 3; ++c)  // Y = 1/2 is inside, Co = 1/10 becomes 0
    EXPECT_NEAR(h.now.data[c].at(1, 1), 0.5f, 1e-5f) << c;
}

TEST(Accumulate, ClampLeavesSkyNeighboursOut) {
  StillHistory h = noisy_neighbourhood(1);
  for (int k = 0; k < 9; ++k)
    if (k != 4) {
      test::set_pixel(h.guides, k % 3, k / 3, 0.0f, glm::vec3(0));
      h.noisy[0].at(k % 3, k / 3) = 100.0f;
    }
  for (const auto rule : {Rectification::kClamp, Rectification::kClampBox}) {
    accumulate(h.guides, h.noisy, h.by_surface(), {.rectification = rule}, h.before, h.now,
               nullptr);
    EXPECT_NEAR(h.now.data[0].at(1, 1), 0.5f, 1e-5f);
  }
}

TEST(Accumulate, ClampOfColoursLeavesHistoryInsideTheBoxUnchanged) {
  StillHistory h = noisy_neighbourhood(3);
  const float inside[] = {0.52f, 0.5f, 0.49f};
  for (int c = 0; c < 3; ++c) test::fill(h.before.data[c], inside[c]);
  // The three channels vary together, so that the box is flat in chroma: widen it.
  h.noisy[0].at(0, 0) += 0.2f;
  h.noisy[2].at(2, 2) += 0.2f;
  h.noisy[1].at(2, 0) += 0.2f;
  const AccumulationRule rule{.alpha = 0.0f, .rectification = Rectification::kClamp};
  accumulate(h.guides, h.noisy, h.by_surface(), rule, h.before, h.now, nullptr);
  // alpha = 1/101: what is left of history, by hand
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(h.now.data[c].at(1, 1), (0.5f + 100 * inside[c]) / 101, 1e-6f) << c;
}

TEST(Accumulate, ClampOfColoursActsInYCoCg) {
  StillHistory h = noisy_neighbourhood(3);  // grey: Co = Cg = 0 everywhere
  test::fill(h.before.data[0], 0.6f);
  test::fill(h.before.data[1], 0.5f);
  test::fill(h.before.data[2], 0.4f);
  const AccumulationRule rule{.alpha = 0.0f, .rectification = Rectification::kClamp};
  accumulate(h.guides, h.noisy, h.by_surface(), rule, h.before, h.now, nullptr);
  for (int c = 0; c < 3; ++c)  // Y = 1/2 is inside, Co = 1/10 becomes 0
    EXPECT_NEAR(h.now.data[c].at(1, 1), 0.5f, 1e-5f) << c;
}

TEST(Accumulate, FallbackClampSparesTheShadowVector) {
  StillHistory h = noisy_neighbourhood(1);
  h.follow_shadow(1, 1, 1, 1);
  const AccumulationRule rule{.alpha = 0.1f, .rectification = Rectification::kClampFallback};
  accumulate(h.guides, h.noisy, h.by_effect(), rule, h.before, h.now, nullptr);
  EXPECT_NEAR(h.now.data[0].at(1, 1), 0.05f + 0.9f * 5.0f, 1e-5f);
  EXPECT_LT(h.now.data[0].at(0, 0), 1.0f);
}

TEST(Accumulate, MomentsFollowTheSameBlend) {
  StillHistory h(1, 1, 1, HistoryExtras::kMoments);
  test::fill(h.noisy[0], 0.5f);
  test::fill(h.before.moment(1), 0.8f);
  test::fill(h.before.moment(2), 0.7f);
  test::fill(h.before.samples(), 100.0f);
  accumulate(h.guides, h.noisy, h.by_surface(), {.alpha = 0.25f}, h.before, h.now, nullptr);
  EXPECT_NEAR(h.now.moment(1).at(0, 0), 0.25f * 0.5f + 0.75f * 0.8f, 1e-6f);
  EXPECT_NEAR(h.now.moment(2).at(0, 0), 0.25f * 0.25f + 0.75f * 0.7f, 1e-6f);
}

TEST(Accumulate, DebugTellsMotionSamplesAndWeightOfHistory) {
  StillHistory h(2, 1, 1);
  test::fill(h.before.samples(), 3.0f);
  h.follow_shadow(0, 0, 1, 0);
  h.surface.taps[0].at(1, 0) = {};
  Channels<float> debug(2, 1, kDebugChannels);
  accumulate(h.guides, h.noisy, h.by_effect(), {.alpha = 0.1f}, h.before, h.now, &debug);
  EXPECT_EQ(debug[kDebugX].at(0, 0), 1.0f);
  EXPECT_EQ(debug[kDebugFrames].at(0, 0), 3.0f);
  EXPECT_FLOAT_EQ(debug[kDebugTrust].at(0, 0), 0.75f);
  EXPECT_EQ(debug[kDebugFrames].at(1, 0), 0.0f);
  EXPECT_EQ(debug[kDebugTrust].at(1, 0), 0.0f);
}

}  // namespace
}  // namespace holdfast
