#include "core/history/expected_error.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "core/motion/follow_block.h"
#include "tests/core/history_world.h"

namespace holdfast {
namespace {

constexpr int kWidth = 20, kHeight = 16;

struct Blend : test::StillHistory {
  Channels<float> variance{kWidth, kHeight, 1};
  BlendScratch scratch{kWidth, kHeight};
  WindowScratch window{kWidth, kHeight};

  Blend() : StillHistory(kWidth, kHeight, 1) { test::fill(variance[0], 0.25f); }
  void run(const HistorySources& sources, const ExpectedErrorRule& rule = {},
           Channels<float>* debug = nullptr) {
    blend_by_expected_error(guides, noisy, sources, std::as_const(variance)[0], nullptr, rule,
                            before, scratch, window, now, debug);
  }
};

/// Coins of probability 1/2: mean 1/2, variance 1/4.
void toss(Channels<float>& noisy, test::Random& random) {
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) noisy[0].at(x, y) = random.uniform() < 0.5 ? 0.0f : 1.0f;
}

double mean_of(ChannelView<const float> image) {
  double sum = 0;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) sum += double(image.at(x, y));
  return sum / (kWidth * kHeight);
}

double rmse_to(ChannelView<const float> image, double truth) {
  double sum = 0;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const double error = double(image.at(x, y)) - truth;
      sum += error * error;
    }
  return std::sqrt(sum / (kWidth * kHeight));
}

TEST(ExpectedError, WithoutCandidateTheCurrentFramePasses) {
  Blend b;
  test::Random random(41);
  test::fill_random(b.noisy[0], random, 0, 1);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) b.surface.taps[0].at(x, y) = {};
  b.run(b.by_surface());
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      ASSERT_EQ(b.now.data[0].at(x, y), b.noisy[0].at(x, y));
      ASSERT_EQ(b.now.samples().at(x, y), 1.0f);
    }
}

// A shadow at rest: the difference of means is noise, and nearly always under its threshold.
TEST(ExpectedError, UnbiasedStaticHistoryGrowsToTheCap) {
  Blend b;
  test::Random random(42);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) b.follow_shadow(x, y, x, y);
  toss(b.before.data, random);
  for (int frame = 0; frame < 200; ++frame) {
    toss(b.noisy, random);
    b.run(b.by_effect());
    std::swap(b.before, b.now);
  }
  EXPECT_GT(mean_of(std::as_const(b.before).samples()), 0.8 * 64);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) ASSERT_LE(b.before.samples().at(x, y), 64.0f);
  // 64 equal samples of variance 1/4 leave a deviation of 1/16; the single frame has 1/2.
  EXPECT_LT(rmse_to(std::as_const(b.before).data[0], 0.5), 1.3 / 16);
}

// The measured difference is subtracted, so that what remains of a grossly wrong history is the
// noise of the mean of a window: far nearer to the truth than the history.
TEST(ExpectedError, GrosslyWrongHistoryIsRejected) {
  Blend b;
  test::Random random(43);
  toss(b.noisy, random);
  test::fill_random(b.before.data[0], random, 99, 101);
  test::fill(b.before.samples(), 64.0f);
  b.run(b.by_surface());
  EXPECT_NEAR(mean_of(std::as_const(b.now).data[0]), 0.5, 0.1);
  EXPECT_LE(rmse_to(std::as_const(b.now).data[0], 0.5), 0.8);
}

TEST(ExpectedError, ConstantOffsetOfHistoryIsCorrected) {
  Blend b;
  test::fill(b.noisy[0], 0.5f);
  test::fill(b.before.data[0], 1.5f);
  test::fill(b.before.samples(), 64.0f);
  test::fill(b.variance[0], 1e-3f);
  b.run(b.by_surface());
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) ASSERT_NEAR(b.now.data[0].at(x, y), 0.5f, 1e-3f);
}

/// Two passes of 3x3 means on a flat wall, the second at `step`: of values, or of variances.
std::vector<double> plain_window(const std::vector<double>& in, int step, bool variances) {
  std::vector<double> between(in.size()), out(in.size());
  const auto pass = [&](const std::vector<double>& from, std::vector<double>& to, int reach) {
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        double sum = 0, n = 0;
        for (int j = y - reach; j <= y + reach; j += reach)
          for (int i = x - reach; i <= x + reach; i += reach)
            if (i >= 0 && j >= 0 && i < kWidth && j < kHeight) {
              sum += from[static_cast<std::size_t>(j * kWidth + i)];
              n += 1;
            }
        to[static_cast<std::size_t>(y * kWidth + x)] = sum / (variances ? n * n : n);
      }
  };
  pass(in, between, 1);
  pass(between, out, step);
  return out;
}

struct Promise {
  double error, share, samples;
};

/// The documented formula for one candidate.
Promise promise_of(double n, double v, double d, double inverse_m, double threshold,
                   const ExpectedErrorRule& rule) {
  const double u = (v + v / n) * inverse_m;
  const double bias2 = std::max(0.0, d * d - threshold * u);
  const double s = bias2 / (bias2 + u);
  return {v / n + double(rule.spatial_samples) * ((1 - s) * (1 - s) * bias2 + s * s * u), s, n};
}

// Float rounding through two means and a handful of operations on values in 0..1; differences that
// meet a threshold shift smoothly, so that no case needs to be left out.
constexpr double kTolerance = 2e-5;

TEST(ExpectedError, AgreesWithTheDocumentedFormulaForTwoCandidates) {
  Blend b;
  test::Random random(45);
  test::fill_random(b.noisy[0], random, 0, 1);
  test::fill_random(b.before.data[0], random, 0, 1);
  test::fill_random(b.before.samples(), random, 1, 64);
  test::fill_random(b.variance[0], random, 0.05f, 0.25f);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const std::uint32_t kind = random.bits() % 4;
      if (kind == 0) b.surface.taps[0].at(x, y) = {};
      if (kind >= 1) b.follow_shadow(x, y, (x + 3) % kWidth, (y + 5) % kHeight);
      if (kind >= 2) b.shadow.motion[0].at(x, y) = random.real(-0.2f, 0.2f);
      if (kind >= 2) b.shadow.motion[1].at(x, y) = random.real(-0.2f, 0.2f);
      b.shadow.motion[kMotionSweep].at(x, y) = random.real(0.0f, 0.2f);
    }
  const ExpectedErrorRule rule;
  b.run(b.by_effect(), rule);

  std::vector<double> difference[2], value[2], samples[2];
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      for (const int which : {0, 1}) {
        const Taps& taps = which == 0 ? b.surface.taps[0].at(x, y) : b.shadow.taps[0].at(x, y);
        const int qx = which == 0 ? x : (x + 3) % kWidth, qy = which == 0 ? y : (y + 5) % kHeight;
        const double current = b.noisy[0].at(x, y);
        value[which].push_back(taps.any() ? double(b.before.data[0].at(qx, qy)) : current);
        samples[which].push_back(taps.any() ? double(b.before.samples().at(qx, qy)) : 0);
        difference[which].push_back(value[which].back() - current);
      }
  const auto inverse_m =
      plain_window(std::vector<double>(kWidth * kHeight, 1.0), rule.window_step, true);
  const std::vector<double> mean[2] = {plain_window(difference[0], rule.window_step, false),
                                       plain_window(difference[1], rule.window_step, false)};
  int by_shadow = 0, by_none = 0;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const auto at = static_cast<std::size_t>(y * kWidth + x);
      double move = b.shadow.motion[kMotionSweep].at(x, y);
      if (samples[1][at] > 0) {
        const double slide_px = std::abs(double(b.shadow.motion[0].at(x, y))) +
                                std::abs(double(b.shadow.motion[1].at(x, y)));
        move = move * slide_px / std::max(move + slide_px, 1e-9);
      }
      const double threshold =
          double(rule.noise_threshold) +
          double(rule.slow_threshold) * std::exp(-move / double(rule.slow_move)) +
          double(rule.rest_threshold) * std::exp(-move / double(rule.rest_move));
      const double v = b.variance[0].at(x, y);
      Promise p[2] = {};
      for (const int which : {0, 1})
        if (samples[which][at] > 0)
          p[which] =
              promise_of(samples[which][at], v, mean[which][at], inverse_m[at], threshold, rule);
      int take = -1;
      if (samples[0][at] > 0) take = 0;
      if (samples[1][at] > 0 &&
          (take < 0 || p[1].error < double(rule.surface_advantage) * p[0].error))
        take = 1;
      double want = b.noisy[0].at(x, y);
      if (take >= 0) {
        const Promise& chosen = p[take];
        const double k = std::min(v / chosen.error, 63.0);
        const double corrected = std::clamp(value[take][at] - chosen.share * mean[take][at], 0.0,
                                            std::max(value[take][at], 1.0));
        want = (want + k * corrected) / (1 + k);
      }
      by_shadow += take == 1 ? 1 : 0;
      by_none += take < 0 ? 1 : 0;
      ASSERT_NEAR(b.now.data[0].at(x, y), want, kTolerance) << x << ", " << y << " takes " << take;
    }
  EXPECT_GT(by_shadow, 50);
  EXPECT_GT(by_none, 10);
}

// Four shadows at the same small difference: one at rest, one that slides by 20 pixels across a
// sharp edge, one that slides as far within a penumbra 100 times as wide, and one whose vector
// leads nowhere before a light that it sweeps.
TEST(ExpectedError, TheMoreOfItsPenumbraAShadowMovesTheLessItKeeps) {
  const auto trust = [](float slide_px, float sweep, bool followed) {
    Blend b;
    test::fill(b.noisy[0], 0.5f);
    test::fill(b.before.data[0], 0.6f);
    test::fill(b.before.samples(), 64.0f);
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        if (followed) b.follow_shadow(x, y, x, y);
        b.shadow.motion[kMotionX].at(x, y) = slide_px;
        b.shadow.motion[kMotionSweep].at(x, y) = sweep;
      }
    Channels<float> debug(kWidth, kHeight, kDebugChannels);
    b.run(b.by_effect(), {}, &debug);
    return debug[kDebugTrust].at(10, 8);
  };
  EXPECT_GT(trust(0, 0, true), 0.95f);
  EXPECT_LT(trust(20, 10, true), 0.85f);
  EXPECT_GT(trust(20, 0.002f, true), 0.95f);
  EXPECT_LT(trust(0, 1, false), 0.85f);
}

// The frame and its history agree, so that nothing else would turn the history down.
TEST(ExpectedError, InTheShadowOfWhatHasAppearedOnlyTheFrameCounts) {
  Blend b;
  test::fill(b.noisy[0], 0.5f);
  test::fill(b.before.data[0], 0.51f);
  test::fill(b.before.samples(), 64.0f);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      b.follow_shadow(x, y, x, y);
      b.shadow.motion[kMotionSweep].at(x, y) = x < kWidth / 2 ? kAppearedSweep : 0.0f;
    }
  b.run(b.by_effect());
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const bool appeared = x < kWidth / 2;
      ASSERT_EQ(b.now.samples().at(x, y) == 1.0f, appeared) << x << ", " << y;
      if (appeared) {
        ASSERT_EQ(b.now.data[0].at(x, y), 0.5f);
      }
    }
}

}  // namespace
}  // namespace holdfast
