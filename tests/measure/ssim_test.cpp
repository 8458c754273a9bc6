#include "client/measure/ssim.h"

#include <gtest/gtest.h>

#include "tests/measure/test_images.h"

namespace holdfast::measure {
namespace {

double value(float x) { return static_cast<double>(x); }

TEST(Ssim, IdenticalImagesScoreOne) {
  const Image image = test::Noise(5).image(33, 12, 3);
  for (const float score : SsimReference(image, test::all(image)).map(image))
    EXPECT_EQ(score, 1.0f);
}

TEST(Ssim, ConstantImagesScoreTheirLuminanceTerm) {
  const Image a = test::constant(20, 15, {0.25f}), b = test::constant(20, 15, {0.5f});
  const double expected = (2 * 0.25 * 0.5 + 1e-4) / (0.25 * 0.25 + 0.5 * 0.5 + 1e-4);
  for (const float score : SsimReference(a, test::all(a)).map(b))
    EXPECT_NEAR(value(score), expected, 2e-4);  // float variances are wrong by 1e-7 of C2 = 9e-4
}

TEST(Ssim, InvertedCheckerboardScoresMinusItsContrast) {
  // Far from borders, a checkerboard of 0 and 1 has mean 1/2 and, up to the window's response at
  // the highest frequency (below 1e-4 here), variance 1/4; its inverse has covariance -1/4.
  Image board(32, 32, 1), inverse(32, 32, 1);
  for (std::size_t i = 0; i < board.pixels(); ++i) {
    board.values[i] = (i / 32 + i) % 2 == 0 ? 0.0f : 1.0f;
    inverse.values[i] = 1.0f - board.values[i];
  }
  const auto map = SsimReference(board, test::all(board)).map(inverse);
  EXPECT_NEAR(value(map[16 * 32 + 16]), (-0.5 + 9e-4) / (0.5 + 9e-4), 1e-3);
}

TEST(Ssim, ChannelsAreAveraged) {
  test::Noise noise(8);
  const Image a = noise.image(16, 16, 1), b = noise.image(16, 16, 1);
  Image a2(16, 16, 2), b2(16, 16, 2);
  for (std::size_t i = 0; i < a.pixels(); ++i) {
    a2.channel(0)[i] = a2.channel(1)[i] = b2.channel(1)[i] = a.values[i];
    b2.channel(0)[i] = b.values[i];
  }
  const auto one = SsimReference(a, test::all(a)).map(b);
  const auto two = SsimReference(a2, test::all(a)).map(b2);
  for (std::size_t i = 0; i < one.size(); ++i)
    EXPECT_NEAR(value(two[i]), (value(one[i]) + 1) / 2, 1e-6);
}

// Expected values: the definition evaluated in double precision by a script in another language.
TEST(Ssim, WindowsLeaveOutSkyAndWhatIsOutside) {
  test::Noise noise(1);
  const Image x = noise.image(17, 24, 1), y = noise.image(17, 24, 1);
  Mask surface(x.pixels(), 1);
  for (std::size_t v = 0; v < 24; ++v)
    for (std::size_t u = 0; u < 17; ++u)
      if (u < 3 || (v >= 10 && v < 13 && u >= 8 && u < 11)) surface[v * 17 + u] = 0;
  const auto map = SsimReference(x, surface).map(y);
  EXPECT_NEAR(value(map[0 * 17 + 3]), 0.052165, 2e-5);
  EXPECT_NEAR(value(map[11 * 17 + 7]), 0.080894, 2e-5);
  EXPECT_NEAR(value(map[23 * 17 + 16]), 0.436316, 2e-5);
  EXPECT_NEAR(value(map[6 * 17 + 12]), -0.024719, 2e-5);
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < map.size(); ++i)
    if (surface[i]) sum += value(map[i]), ++count;
  EXPECT_NEAR(sum / count, 0.033671, 2e-5);
}

}  // namespace
}  // namespace holdfast::measure
