#include "core/spatial/window.h"

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
  ChannelView<const float> run(int step) { return window_means(guides, in, 2, step, scratch, out); }
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
  Channels<float> in(1, 1, 1), out(1, 1, 1);
  in[0].at(0, 0) = 0.3f;
  WindowScratch scratch(1, 1);
  const auto inverse_n = window_means(guides, in, 1, 3, scratch, out);
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

}  // namespace
}  // namespace holdfast
