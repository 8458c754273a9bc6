#include "client/measure/warp.h"

#include <gtest/gtest.h>

#include "tests/core/small_world.h"

namespace holdfast::measure {
namespace {

constexpr int kWidth = 33, kHeight = 18;  // rows are padded

/// Taps of a wall that lies (dx, dy) pixels away in the frame before.
Channels<Taps> shifted_taps(float dx, float dy) {
  const Guides wall = test::wall(test::orthographic_camera(kWidth, kHeight), kWidth, kHeight);
  Channels<Taps> taps(kWidth, kHeight, 1);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      taps[0].at(x, y) =
          find_taps(wall, static_cast<float>(x) + 0.5f + dx, static_cast<float>(y) + 0.5f + dy,
                    {wall.position_at(x, y), wall.normal_at(x, y), 1});
  return taps;
}

Plane random_image() {
  Plane image({PlaneKind::kGlossy, {}}, kWidth, kHeight);
  test::Random random(7);
  for (int c = 0; c < 3; ++c) test::fill_random(image.channel(c), random, 0.0f, 2.0f);
  return image;
}

TEST(Warp, ATranslationByWholePixelsIsExact) {
  const Plane previous = random_image();
  const Channels<Taps> taps = shifted_taps(3, -2);
  const Warped warped = warp(previous, taps[0]);
  for (int y = 3; y < kHeight; ++y)
    for (int x = 0; x < kWidth - 4; ++x) {
      ASSERT_TRUE(warped.found[static_cast<std::size_t>(y * kWidth + x)]);
      for (int c = 0; c < 3; ++c)
        ASSERT_EQ(warped.image.channel(c).at(x, y), previous.channel(c).at(x + 3, y - 2));
    }
}

TEST(Warp, ALinearImageIsExactBetweenPixels) {
  Plane previous({PlaneKind::kGlossy, {}}, kWidth, kHeight);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      previous.channel(1).at(x, y) = static_cast<float>(2 * x + 5 * y);
  const Warped warped = warp(previous, shifted_taps(1.25f, 0.5f)[0]);
  for (int y = 0; y < kHeight - 2; ++y)
    for (int x = 0; x < kWidth - 3; ++x)
      ASSERT_NEAR(warped.image.channel(1).at(x, y),
                  static_cast<float>(2 * x + 5 * y) + 2 * 1.25f + 5 * 0.5f, 1e-3f);
}

TEST(Warp, WhatLeadsNowhereTakesTheFallbackOrIsNotFound) {
  const Plane previous = random_image();
  const Channels<Taps> away = shifted_taps(5, 0), still = shifted_taps(0, 0);
  const std::size_t last = kWidth - 1;
  const Warped alone = warp(previous, away[0]);
  EXPECT_FALSE(alone.found[last]);
  EXPECT_EQ(alone.image.channel(0).at(kWidth - 1, 0), 0.0f);
  const Warped helped = warp(previous, away[0], still[0]);
  EXPECT_TRUE(helped.found[last]);
  EXPECT_EQ(helped.image.channel(0).at(kWidth - 1, 0), previous.channel(0).at(kWidth - 1, 0));
  EXPECT_EQ(helped.image.channel(0).at(0, 0), previous.channel(0).at(5, 0));
}

}  // namespace
}  // namespace holdfast::measure
