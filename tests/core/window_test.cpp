#include "core/spatial/window.h"

#include <cmath>
#include <utility>

#include <gtest/gtest.h>

#include "tests/core/small_world.h"

namespace holdfast {
namespace {

constexpr int kWidth = 24, kHeight = 20;

struct Window {
  Guides guides = test::wall(test::orthographic_camera(kWidth, kHeight), kWidth, kHeight);
  Channels<float> in{kWidth, kHeight, 2}, out{kWidth, kHeight, 2};
  WindowScratch scratch{kWidth, kHeight};

  Window() {
    test::Random random(31);
    for (int c = 0; c < 2; ++c) test::fill_random(in[c], random, 0, 1);
  }
  ChannelView<const float> run(int step) {
    return counted_window_means(guides, in, 2, step, scratch, out);
  }
};

TEST(WindowMeans, OfStepThreeAreMeansOfEightyOneEqualSamples) {
  Window w;
  const auto inverse_n = w.run(3);
  for (int y = 4; y < kHeight - 4; ++y)
    for (int x = 4; x < kWidth - 4; ++x) {
      double sum[2] = {};
      for (int j = -4; j <= 4; ++j)
        for (int i = -4; i <= 4; ++i)
          for (int c = 0; c < 2; ++c) sum[c] += double(w.in[c].at(x + i, y + j));
      for (int c = 0; c < 2; ++c) ASSERT_NEAR(w.out[c].at(x, y), sum[c] / 81, 2e-6);
      ASSERT_NEAR(inverse_n.at(x, y), 1.0f / 81, 1e-7f);
    }
}

TEST(WindowMeans, OfStepTwoOverlapToSevenPixels) {
  Window w;
  w.run(2);
  const double weight[7] = {1, 1, 2, 1, 2, 1, 1};
  for (int y = 3; y < kHeight - 3; ++y)
    for (int x = 3; x < kWidth - 3; ++x) {
      double sum = 0;
      for (int j = -3; j <= 3; ++j)
        for (int i = -3; i <= 3; ++i)
          sum += weight[i + 3] * weight[j + 3] * double(w.in[0].at(x + i, y + j));
      ASSERT_NEAR(w.out[0].at(x, y), sum / 81, 2e-6);
    }
}

TEST(WindowMeans, CountOnlyTheSamplesInsideTheImage) {
  Window w;
  const auto inverse_n = w.run(3);
  // At the corner the window keeps 5 of 9 columns, in thirds of 2 and 3: (1/2 + 1/3) / 4 a
  // direction.
  const float share = (1.0f / 2 + 1.0f / 3) / 4;
  EXPECT_NEAR(inverse_n.at(0, 0), share * share, 1e-6f);
}

TEST(WindowMeans, OfASinglePixelAreThePixel) {
  const Guides guides = test::wall(test::perspective_camera(1, 1), 1, 1);
  Channels<float> in(1, 1, 2), out(1, 1, 2);
  in[0].at(0, 0) = 0.3f;
  WindowScratch scratch(1, 1);
  const auto inverse_n = counted_window_means(guides, in, 2, 3, scratch, out);
  EXPECT_FLOAT_EQ(out[0].at(0, 0), 0.3f);
  EXPECT_FLOAT_EQ(inverse_n.at(0, 0), 1.0f);
}

TEST(WindowMeans, StopAtEdgesOfDepthAndNormal) {
  for (const bool by_normal : {false, true}) {
    Window w;
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        w.in[0].at(x, y) = x < 12 ? 1.0f : 1000.0f;
        if (x < 12) continue;
        test::set_pixel(w.guides, x, y, by_normal ? 5.0f : 50.0f,
                        by_normal ? glm::vec3(1, 0, 0) : glm::vec3(0, 0, 1), 1);
      }
    w.run(3);
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x)
        ASSERT_NEAR(w.out[0].at(x, y), x < 12 ? 1.0f : 1000.0f, x < 12 ? 1e-5f : 1e-2f)
            << (by_normal ? "normal " : "depth ") << x;
  }
}

TEST(WindowMeans, GoToTheChannelsFromTheFirstOneOnAndToNoOthers) {
  Window w;
  w.run(2);
  Channels<float> wide(kWidth, kHeight, 5);
  for (int c = 0; c < 5; ++c) test::fill(wide[c], -7.0f);
  counted_window_means(w.guides, w.in, 2, 2, w.scratch, wide, 2);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      for (const int c : {0, 1, 4}) ASSERT_EQ(wide[c].at(x, y), -7.0f) << c;
      for (const int c : {0, 1}) ASSERT_EQ(wide[2 + c].at(x, y), w.out[c].at(x, y)) << c;
    }
}

TEST(WindowMeans, AreTheSameWithoutTheirCounts) {
  Window w;
  for (const int step : {2, 3}) {
    w.run(step);
    Channels<float> alone(kWidth, kHeight, 2);
    window_means(w.guides, w.in, 2, step, w.scratch, alone);
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x)
        for (const int c : {0, 1})
          ASSERT_EQ(alone[c].at(x, y), w.out[c].at(x, y)) << x << ", " << y << ", step " << step;
  }
}

/// Four channels on the same wall, with a footprint of precision E, F, G everywhere.
struct FootprintWindow {
  Guides guides = test::wall(test::orthographic_camera(kWidth, kHeight), kWidth, kHeight);
  Channels<float> in{kWidth, kHeight, 4}, out{kWidth, kHeight, 4}, footprint{kWidth, kHeight, 3};
  WindowScratch scratch{kWidth, kHeight};

  FootprintWindow(float e, float f, float g) {
    test::Random random(32);
    for (int c = 0; c < 4; ++c) test::fill_random(in[c], random, 0, 1);
    test::fill(footprint[0], e);
    test::fill(footprint[1], f);
    test::fill(footprint[2], g);
  }
  ChannelView<const float> run(const Channels<float>* within) {
    return counted_window_means(guides, in, 4, 2, scratch, out, 0, nullptr, within);
  }
};

TEST(WindowMeans, WithinAFootprintAreTwoWeightedPasses) {
  const double e = 0.3, f = -0.1, g = 0.15;
  FootprintWindow w(0.3f, -0.1f, 0.15f);
  const auto inverse_n = w.run(&w.footprint);
  const auto weight = [&](int dx, int dy) {
    return std::exp(-(e * dx * dx + 2 * f * dx * dy + g * dy * dy));
  };
  for (int y = 3; y < kHeight - 3; ++y)
    for (int x = 3; x < kWidth - 3; ++x) {
      double sum[4] = {}, total = 0, squares = 0;
      for (int j = -1; j <= 1; ++j)
        for (int i = -1; i <= 1; ++i) {
          double inner[4] = {}, inner_total = 0, inner_squares = 0;
          for (int v = -1; v <= 1; ++v)
            for (int u = -1; u <= 1; ++u) {
              for (int c = 0; c < 4; ++c)
                inner[c] += weight(u, v) * double(w.in[c].at(x + 2 * i + u, y + 2 * j + v));
              inner_total += weight(u, v);
              inner_squares += weight(u, v) * weight(u, v);
            }
          const double outer = weight(2 * i, 2 * j);
          for (int c = 0; c < 4; ++c) sum[c] += outer * inner[c] / inner_total;
          total += outer;
          squares += outer * outer * inner_squares / (inner_total * inner_total);
        }
      for (int c = 0; c < 4; ++c) ASSERT_NEAR(w.out[c].at(x, y), sum[c] / total, 5e-6) << c;
      ASSERT_NEAR(inverse_n.at(x, y), squares / (total * total), 5e-6);
    }
}

TEST(WindowMeans, WithinAnEndlessFootprintAreThoseWithoutOne) {
  FootprintWindow w(0, 0, 0);
  w.run(nullptr);
  const Channels<float> plain = std::exchange(w.out, Channels<float>(kWidth, kHeight, 4));
  w.run(&w.footprint);
  for (int c = 0; c < 4; ++c)
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) ASSERT_NEAR(w.out[c].at(x, y), plain[c].at(x, y), 1e-6f);
}

TEST(WindowMeans, WithinAPointsFootprintAreThePixels) {
  FootprintWindow w(90, 0, 90);
  const auto inverse_n = w.run(&w.footprint);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      for (int c = 0; c < 4; ++c) ASSERT_EQ(w.out[c].at(x, y), w.in[c].at(x, y));
      ASSERT_EQ(inverse_n.at(x, y), 1.0f);
    }
}

}  // namespace
}  // namespace holdfast
