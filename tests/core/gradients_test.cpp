#include "core/history/gradients.h"

#include <gtest/gtest.h>

#include "core/history/accumulate.h"
#include "tests/core/history_world.h"

namespace holdfast {
namespace {

constexpr PlaneId kGlossyGradient{PlaneKind::kGradient, {ComponentKind::kGlossy, 0}};
constexpr float kLargest = 1e15f;

/// A wall and gradient samples of it, all (now, then) at first.
struct Gradients {
  Guides guides;
  Plane plane;
  GradientScratch scratch;

  Gradients(int width, int height, float now, float then)
      : guides(test::wall(test::orthographic_camera(width, height), width, height)),
        scratch(width, height) {
    const PlaneSize size = plane_size(kGlossyGradient, width, height);
    plane = Plane(kGlossyGradient, size.width, size.height);
    test::fill(plane.channel(0), now);
    test::fill(plane.channel(1), then);
  }
  void set(int x, int y, float now, float then) {
    plane.channel(0).at(x, y) = now;
    plane.channel(1).at(x, y) = then;
  }
  ChannelView<const float> antilag(int levels = 3) {
    load_gradients(plane, kLargest, scratch);
    return antilag_of_gradients(guides, levels, scratch);
  }
};

TEST(Gradients, OfLightThatStaysAreExactlyZeroWhateverTheNoise) {
  Gradients g(31, 22, 0, 0);
  test::Random random(3);
  for (int y = 0; y < g.plane.height(); ++y)
    for (int x = 0; x < g.plane.width(); ++x) {
      const float value = random.real(0, 5);
      g.set(x, y, value, value);
    }
  const auto lambda = g.antilag();
  for (int y = 0; y < lambda.height; ++y)
    for (int x = 0; x < lambda.width; ++x) EXPECT_EQ(lambda.at(x, y), 0.0f);
}

TEST(Gradients, OfAChangeEverywhereAreItsShareOfTheBrighterSide) {
  for (const auto& [width, height] :
       {std::pair{1, 1}, {2, 7}, {3, 3}, {4, 1}, {31, 22}, {200, 9}}) {
    SCOPED_TRACE(testing::Message() << width << "x" << height);
    Gradients brighter(width, height, 4.0f, 1.0f), darker(width, height, 1.0f, 2.0f);
    const int levels = 1 + width % 2;
    EXPECT_EQ(brighter.antilag().width, (width + 2) / 3);
    EXPECT_EQ(brighter.antilag().height, (height + 2) / 3);
    for (int y = 0; y < (height + 2) / 3; ++y)
      for (int x = 0; x < (width + 2) / 3; ++x) {
        EXPECT_NEAR(brighter.antilag(levels).at(x, y), 0.75f, 1e-5f);
        EXPECT_NEAR(darker.antilag(levels).at(x, y), 0.5f, 1e-5f);
      }
  }
}

TEST(Gradients, WithoutSampleCountForNothing) {
  Gradients g(30, 30, 0.0f, 0.0f);
  g.set(5, 5, 3.0f, 0.0f);
  const auto lambda = g.antilag();
  EXPECT_EQ(lambda.at(5, 5), 1.0f) << "the only sample says that all is new";
  EXPECT_EQ(lambda.at(6, 6), 1.0f);
  Gradients dark(9, 9, 0.0f, 0.0f);
  EXPECT_EQ(dark.antilag().at(1, 1), 0.0f);
}

TEST(Gradients, StayOnTheirSurface) {
  Gradients g(60, 30, 1.0f, 1.0f);
  for (int y = 0; y < 30; ++y)
    for (int x = 30; x < 60; ++x) test::set_pixel(g.guides, x, y, 90.0f, {0, 0, 1}, 2);
  for (int y = 0; y < 10; ++y)
    for (int x = 10; x < 20; ++x) g.set(x, y, 1.0f, 0.0f);
  const auto lambda = g.antilag();
  for (int y = 0; y < 10; ++y)
    for (int x = 0; x < 20; ++x) EXPECT_NEAR(lambda.at(x, y), x < 10 ? 0.0f : 1.0f, 1e-6f) << x;
}

// A step of 60 pixel widths weighs e^-60: enough for a float, and nothing to go by.
TEST(Gradients, OfAnotherSurfaceCountForNothingWhereTheOwnHasNone) {
  Gradients g(60, 30, 0.0f, 0.0f);
  for (int y = 0; y < 30; ++y)
    for (int x = 30; x < 60; ++x) {
      const float step = 60 * 3 * static_cast<float>(g.guides.view.pixel_angle);
      test::set_pixel(g.guides, x, y, 5.0f + step, {0, 0, 1}, 2);
    }
  for (int y = 0; y < 10; ++y)
    for (int x = 10; x < 20; ++x) g.set(x, y, 1.0f, 0.0f);
  const auto lambda = g.antilag(1);
  for (int y = 0; y < 10; ++y)
    for (int x = 0; x < 20; ++x) EXPECT_NEAR(lambda.at(x, y), x < 10 ? 0.0f : 1.0f, 1e-6f) << x;
}

TEST(Gradients, OfNoiseInBothDirectionsCancel) {
  Gradients g(90, 90, 0.0f, 0.0f);
  test::Random random(9);
  for (int y = 0; y < 30; ++y)
    for (int x = 0; x < 30; ++x) {
      const bool brighter = random.uniform() < 0.5;
      g.set(x, y, brighter ? 1.0f : 0.0f, brighter ? 0.0f : 1.0f);
    }
  const auto lambda = g.antilag();
  float sum = 0;
  for (int y = 0; y < 30; ++y)
    for (int x = 0; x < 30; ++x) sum += lambda.at(x, y);
  EXPECT_LT(sum / 900, 0.12f);
}

TEST(Gradients, ThatAreNoRadianceAreRepairedAndCounted) {
  Gradients g(9, 3, 1.0f, 1.0f);
  g.set(0, 0, test::kNaN, 1.0f);
  g.set(1, 0, 1.0f, -1.0f);
  g.set(2, 0, 1e30f, test::kInf);
  EXPECT_EQ(load_gradients(g.plane, kLargest, g.scratch), 4u);
  for (int x = 0; x < 3; ++x)
    for (int c = 0; c < 2; ++c) EXPECT_EQ(g.scratch.samples[c].at(x, 0), 0.0f) << x;
  g.set(2, 0, 1e30f, 1.0f);
  load_gradients(g.plane, kLargest, g.scratch);
  EXPECT_EQ(g.scratch.samples[1].at(2, 0), kLargest);
  EXPECT_EQ(g.antilag().at(2, 0), 1.0f);
}

TEST(Accumulate, GradientsTakeAlphaTowardsOneAndShortenHistory) {
  test::StillHistory h(7, 1, 1, HistoryExtras::kMoments);
  test::fill(h.noisy[0], 1.0f);
  test::fill(h.before.samples(), 100.0f);
  Channels<float> lambda(3, 1, 1);
  const float values[] = {0.0f, 0.25f, 1.0f};
  for (int k = 0; k < 3; ++k) lambda[0].at(k, 0) = values[k];
  HistorySources sources = h.by_surface();
  sources.antilag = lambda[0];
  accumulate(h.guides, h.noisy, sources, {.alpha = 0.2f}, h.before, h.now, nullptr);
  for (int x = 0; x < 7; ++x) {
    const float l = values[x / 3], alpha = (1.0f - l) * 0.2f + l;
    EXPECT_NEAR(h.now.data[0].at(x, 0), alpha, 1e-6f) << x;
    EXPECT_NEAR(h.now.moment(1).at(x, 0), alpha, 1e-6f) << x;
  }
  EXPECT_EQ(h.now.samples().at(6, 0), 1.0f);
}

}  // namespace
}  // namespace holdfast
