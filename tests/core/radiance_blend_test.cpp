#include "core/history/radiance_blend.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <gtest/gtest.h>

#include "tests/core/radiance_history.h"

namespace holdfast {
namespace {

constexpr int kWidth = test::RadianceHistory::kWidth, kHeight = test::RadianceHistory::kHeight;
using Blend = test::RadianceHistory;

double mean_of(ChannelView<const float> image) {
  double sum = 0;
  Blend::each([&](int x, int y) { sum += double(image.at(x, y)); });
  return sum / (kWidth * kHeight);
}

double rmse_to(ChannelView<const float> image, double truth) {
  double sum = 0;
  Blend::each([&](int x, int y) {
    sum += (double(image.at(x, y)) - truth) * (double(image.at(x, y)) - truth);
  });
  return std::sqrt(sum / (kWidth * kHeight));
}

TEST(RadianceBlend, WithoutCandidateTheFramePassesAsOneSample) {
  Blend b;
  test::Random random(71);
  b.render(random, {1, 2, 3});
  b.fill_history({50, 50, 50}, 64);
  Blend::each([&](int x, int y) { b.surface.taps[0].at(x, y) = {}; });
  for (const bool with_effect : {false, true}) {
    b.run(with_effect ? b.by_effect() : b.by_surface());
    Blend::each([&](int x, int y) {
      for (int c = 0; c < 3; ++c) ASSERT_EQ(b.now.data[c].at(x, y), b.noisy[c].at(x, y));
      ASSERT_EQ(b.now.samples().at(x, y), 1.0f);
    });
  }
}

TEST(RadianceBlend, UnbiasedHistoryAtRestGrowsToTheCap) {
  Blend b;
  b.at_rest = true;
  test::Random random(72);
  b.render(random, {1, 1, 1});
  for (int c = 0; c < 3; ++c)
    Blend::each([&](int x, int y) { b.before.data[c].at(x, y) = b.noisy[c].at(x, y); });
  for (int frame = 0; frame < 200; ++frame) {
    b.render(random, {1, 1, 1});
    b.step();
  }
  const ComponentHistory& result = b.before;
  // Chance exceeds the thresholds now and then, and a pixel starts anew.
  EXPECT_GT(mean_of(result.samples()), 0.7 * 64);
  Blend::each([&](int x, int y) { ASSERT_LE(result.samples().at(x, y), 64.0f); });
  // One sample has a deviation of 1/sqrt(3), 64 of a recursive mean 1/sqrt(3 * 127) and more.
  EXPECT_LT(rmse_to(result.data[1], 1.0), 1.3 / std::sqrt(3.0 * 64));
  EXPECT_NEAR(mean_of(result.data[1]), 1.0, 0.02);
}

TEST(RadianceBlend, ConstantImageIsAFixedPoint) {
  for (const float level : {1e-6f, 0.5f, 1e6f}) {
    Blend b;
    b.fill_history({level, 2 * level, 3 * level}, 5);
    for (int c = 0; c < 3; ++c) test::fill(b.noisy[c], static_cast<float>(c + 1) * level);
    for (int frame = 0; frame < 20; ++frame) b.step();
    Blend::each([&](int x, int y) {
      for (int c = 0; c < 3; ++c)
        ASSERT_FLOAT_EQ(b.before.data[c].at(x, y), static_cast<float>(c + 1) * level);
    });
  }
}

// What a history of equal values differs by is rounding: it says nothing against the history.
TEST(RadianceBlend, RoundingIsNotTakenForBias) {
  for (const float level : {1e-6f, 0.5f, 1e6f}) {
    Blend b;
    b.fill_history({level * 1.0000003f, level, 2 * level}, 8);
    for (int c = 0; c < 3; ++c) test::fill(b.noisy[c], c < 2 ? level : 2 * level);
    b.run(b.by_surface());
    Blend::each([&](int x, int y) {
      ASSERT_NEAR(std::as_const(b.now).samples().at(x, y), 9.0f, 0.1f) << level;
    });
  }
}

// Luminance alone would see nothing: 0.2126 r + 0.7152 g + 0.0722 b is the same.
TEST(RadianceBlend, ShiftOfHueAtTheSameLuminanceIsFoundAndCorrected) {
  const std::array<float, 3> truth{0.6f, 0.5f, 0.4f};
  const std::array<float, 3> wrong{0.6f + 0.3f, 0.5f - 0.3f * 0.2126f / 0.7152f, 0.4f};
  Blend b;
  test::Random random(73);
  Blend::each([&](int x, int y) {
    for (int c = 0; c < 3; ++c)
      b.noisy[c].at(x, y) = truth[static_cast<std::size_t>(c)] + random.real(-0.05f, 0.05f);
  });
  b.fill_history(wrong, 64);
  b.run(b.by_surface());
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(mean_of(std::as_const(b.now).data[c]), double(truth[static_cast<std::size_t>(c)]),
                0.01)
        << c;
}

TEST(RadianceBlend, AtRestADifferenceMustBeLargerToCount) {
  double kept[2];
  for (const bool at_rest : {false, true}) {
    Blend b;
    b.at_rest = at_rest;
    test::Random random(75);
    b.render(random, {1, 1, 1});
    b.fill_history({1.1f, 1.1f, 1.1f}, 64);
    b.run(b.by_surface());
    kept[at_rest ? 1 : 0] = mean_of(std::as_const(b.now).samples());
  }
  EXPECT_GT(kept[1], 0.7 * 64);
  EXPECT_LT(kept[0], 0.5 * 64);
}

// One sample in 20 is lit, to a mean of 1.5 where history has 0.1: windows of 49 know too little.
TEST(RadianceBlend, ALightThatIsTooWeakForAWindowIsFollowedAtOnceWhereTheFrameShowsIt) {
  for (const bool at_rest : {false, true}) {
    double error[2];
    for (const bool noticed : {false, true}) {
      Blend b;
      b.at_rest = at_rest;
      b.rule.change.noticed = noticed;
      test::Random random(77);
      Blend::each([&](int x, int y) {
        const float lit = random.uniform() < 0.05 ? 30.0f : 0.0f;
        for (int c = 0; c < 3; ++c) b.noisy[c].at(x, y) = lit;
      });
      b.fill_history({0.1f, 0.1f, 0.1f}, 64);
      b.run(b.by_surface());
      error[noticed ? 1 : 0] =
          std::abs(mean_of(std::as_const(b.now).data[1]) - mean_of(std::as_const(b.noisy)[1]));
    }
    EXPECT_LT(error[1], 0.35) << at_rest;  // of 1.5: what chance may show is not expected
    EXPECT_GT(error[0], 1.5 * error[1]) << at_rest;
  }
}

TEST(RadianceBlend, TakesTheBetterOfTwoCandidates) {
  for (const bool effect_is_right : {false, true}) {
    Blend b;
    test::Random random(76);
    b.render(random, {1, 1, 1});
    // The left half of the history is wrong; one candidate leads there, the other to the right.
    Blend::each([&](int x, int y) {
      for (int c = 0; c < 3; ++c) b.before.data[c].at(x, y) = x < kWidth / 2 ? 4.0f : 1.0f;
      b.before.samples().at(x, y) = 32.0f;
      const int right = kWidth - 1 - x % 4, left = x % 4;
      b.surface.taps[0].at(x, y) = identity_taps(b.guides, effect_is_right ? left : right, y);
      b.surface.motion[0].at(x, y) = 11.0f;
      b.follow_shadow(x, y, effect_is_right ? right : left, y);
      b.shadow.motion[0].at(x, y) = 22.0f;
    });
    Channels<float> debug(kWidth, kHeight, kDebugChannels);
    b.run(b.by_effect(), &debug);
    int right = 0;
    Blend::each([&](int x, int y) {
      right += debug[kDebugX].at(x, y) == (effect_is_right ? 22.0f : 11.0f) ? 1 : 0;
      ASSERT_EQ(debug[kDebugFrames].at(x, y), 32.0f);
    });
    EXPECT_GT(right, 0.95 * kWidth * kHeight) << effect_is_right;
  }
}

// The same values behind both: without bias, their errors are as 1 / (1 + samples).
TEST(RadianceBlend, ASecondCandidateMustPromiseATenthLess) {
  for (const float second : {34.0f, 64.0f}) {
    Blend b;
    b.rule.threshold = 1e6f;
    test::Random random(81);
    b.render(random, {1, 1, 1});
    b.fill_history({1, 1, 1}, 32);
    Blend::each([&](int x, int y) {
      if (x >= kWidth / 2) b.before.samples().at(x, y) = second;
      b.surface.taps[0].at(x, y) = identity_taps(b.guides, x % 4, y);
      b.follow_shadow(x, y, kWidth - 1 - x % 4, y);
    });
    Channels<float> debug(kWidth, kHeight, kDebugChannels);
    b.run(b.by_effect(), &debug);
    Blend::each([&](int x, int y) {
      ASSERT_EQ(debug[kDebugFrames].at(x, y), second > 40 ? second : 32.0f) << x << ", " << y;
    });
  }
}

TEST(RadianceBlend, TakesTheOnlyCandidateThereIs) {
  Blend b;
  test::Random random(77);
  b.render(random, {1, 1, 1});
  b.fill_history({1, 1, 1}, 16);
  Blend::each([&](int x, int y) {
    b.surface.taps[0].at(x, y) = {};
    if (x % 2 == 0) b.follow_shadow(x, y, x, y);
  });
  b.run(b.by_effect());
  Blend::each([&](int x, int y) {
    if (x % 2 == 0)
      ASSERT_GT(b.now.samples().at(x, y), 1.0f);
    else
      ASSERT_EQ(b.now.samples().at(x, y), 1.0f);
  });
}

TEST(RadianceBlend, IsFiniteAndNotNegativeForExtremeInputs) {
  const float values[] = {0.0f, 1e-30f, 1.0f, 1e4f, 1e15f};
  for (const float level : values)
    for (const float past : values) {
      Blend b;
      test::Random random(78);
      b.fill_history({past, past, 0}, 64);
      for (int frame = 0; frame < 4; ++frame) {
        Blend::each([&](int x, int y) {
          for (int c = 0; c < 3; ++c)  // fireflies
            b.noisy[c].at(x, y) = random.uniform() < 0.02 ? 1e15f : level;
        });
        b.step();
        Blend::each([&](int x, int y) {
          for (int c = 0; c < 3; ++c) {
            const float v = b.before.data[c].at(x, y);
            ASSERT_TRUE(v >= 0.0f && v <= 1.0001e15f) << level << ' ' << past << ": " << v;
          }
          const float n = b.before.samples().at(x, y);
          ASSERT_TRUE(n >= 1.0f && n <= 64.0f) << n;
        });
      }
    }
}

TEST(RadianceBlend, WithinAFootprintSeesOnlyWhatIsNear) {
  // History is wrong to the right of the middle; a narrow window stays clean of it.
  for (const bool narrow : {false, true}) {
    Blend b;
    b.rule.window_precision = 1.0f;
    test::Random random(80);
    Blend::each([&](int x, int y) {
      for (int c = 0; c < 3; ++c) {
        b.noisy[c].at(x, y) = 1.0f + random.real(-0.1f, 0.1f);
        b.before.data[c].at(x, y) = x < kWidth / 2 ? 1.0f : 3.0f;
      }
      b.before.samples().at(x, y) = 32.0f;
    });
    Channels<float> footprint(kWidth, kHeight, 3);
    for (const int c : {0, 2}) test::fill(footprint[c], 0.7f);
    b.run(b.by_surface(), nullptr, narrow ? &footprint : nullptr);
    double samples = 0;
    for (int y = 0; y < kHeight; ++y) samples += double(b.now.samples().at(kWidth / 2 - 3, y));
    if (narrow)
      EXPECT_GT(samples / kHeight, 10);
    else
      EXPECT_LT(samples / kHeight, 6);
  }
}

}  // namespace
}  // namespace holdfast
