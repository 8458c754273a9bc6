#include "core/spatial/activity.h"

#include <algorithm>
#include <cstdlib>
#include <utility>

#include <gtest/gtest.h>

#include "tests/core/isa_guard.h"
#include "tests/core/small_world.h"

namespace holdfast {
namespace {

/// Smallest and largest value on surfaces within tiles that touch the halo of a tile.
bool varies(const Guides& guides, ChannelView<const float> signal, int x, int y, int halo) {
  constexpr int kW = ActivityMap::kTileWidth, kH = ActivityMap::kTileHeight;
  const int reach_x = (halo + kW - 1) / kW, reach_y = (halo + kH - 1) / kH;
  float low = test::kInf, high = -test::kInf;
  for (int j = std::max((y / kH - reach_y) * kH, 0);
       j < std::min((y / kH + reach_y + 1) * kH, signal.height); ++j)
    for (int i = std::max((x / kW - reach_x) * kW, 0);
         i < std::min((x / kW + reach_x + 1) * kW, signal.width); ++i)
      if (guides.depth().at(i, j) > 0) {
        low = std::min(low, signal.at(i, j));
        high = std::max(high, signal.at(i, j));
      }
  return high - low > 0;
}

TEST(ActivityMap, ZonesAreTheTilesWhoseHaloVaries) {
  const test::IsaGuard guard;
  test::Random random(61);
  for (const auto& [width, height] :
       {std::pair{1, 1}, {1, 40}, {16, 8}, {17, 9}, {131, 67}, {250, 33}}) {
    Guides guides = test::wall(test::orthographic_camera(width, height), width, height);
    Channels<float> image(width, height, 1);
    test::fill(image[0], 0.5f);
    for (int k = 0; k < 3; ++k) {  // a few that differ, and sky that counts for nothing
      const auto x = static_cast<int>(random.uniform(0, width));
      const auto y = static_cast<int>(random.uniform(0, height));
      image[0].at(x, y) = 0.25f;
      if (k == 0) test::set_pixel(guides, x, y, 0.0f, glm::vec3(0));
    }
    test::poison_padding(image[0]);
    const ChannelView<const float> signal = image[0];
    const int halos[] = {0, 4, 14, 40};
    for (const Isa isa : available_isas()) {
      select_isa(isa);
      ActivityMap map(width, height);
      map.measure(guides, {&signal, 1}, halos, 0.0f);
      for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
          for (int zone = 0; zone < 4; ++zone)
            ASSERT_EQ(map.active(x, y, zone), varies(guides, signal, x, y, halos[zone]))
                << isa_name(isa) << " " << width << "x" << height << " at " << x << "," << y
                << " halo " << halos[zone];
    }
  }
}

TEST(ActivityMap, BelowALimitAreTheTilesThatAHaloReaches) {
  constexpr int kWidth = 131, kHeight = 67, kX = 70, kY = 30;
  constexpr int kW = ActivityMap::kTileWidth, kH = ActivityMap::kTileHeight;
  Channels<float> image(kWidth, kHeight, 1);
  test::fill(image[0], 3.5f);  // not below
  ActivityMap map(kWidth, kHeight);
  map.measure_below(std::as_const(image)[0], 3.5f, 4);
  EXPECT_EQ(map.active_share(), 0.0);
  image[0].at(kX, kY) = 3.0f;
  map.measure_below(std::as_const(image)[0], 3.5f, 4);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      ASSERT_EQ(map.active(x, y),
                std::abs(x / kW - kX / kW) <= 1 && std::abs(y / kH - kY / kH) <= 1)
          << x << "," << y;
  test::fill(image[0], 1.0f);  // a constant, all of it below
  map.measure_below(std::as_const(image)[0], 3.5f, 0);
  EXPECT_EQ(map.active_share(), 1.0);
}

TEST(ActivityMap, AroundZeroAConstantIsActive) {
  const Guides guides = test::wall(test::orthographic_camera(20, 10), 20, 10);
  Channels<float> image(20, 10, 1);
  const ChannelView<const float> signal = image[0];
  ActivityMap map(20, 10);
  map.measure(guides, {&signal, 1}, 1, 0.0f, true);
  EXPECT_EQ(map.active_share(), 0.0);
  test::fill(image[0], 0.5f);
  map.measure(guides, {&signal, 1}, 1, 0.0f, true);
  EXPECT_EQ(map.active_share(), 1.0);
  map.measure(guides, {&signal, 1}, 1, 0.0f);
  EXPECT_EQ(map.active_share(), 0.0);
}

// Dim light is filtered as bright light is.
TEST(ActivityMap, ValuesDifferByAShareOfTheLargest) {
  const Guides guides = test::wall(test::orthographic_camera(20, 10), 20, 10);
  Channels<float> image(20, 10, 1);
  const ChannelView<const float> signal = image[0];
  ActivityMap map(20, 10);
  for (const float scale : {1e-8f, 1.0f, -1.0f, 1e8f}) {
    test::fill(image[0], scale);
    image[0].at(3, 3) = scale * (1 + 1e-5f);
    map.measure(guides, {&signal, 1}, 1, 1e-6f);
    EXPECT_EQ(map.active_share(), 1.0) << scale;
    map.measure(guides, {&signal, 1}, 1, 1e-4f);
    EXPECT_EQ(map.active_share(), 0.0) << scale;
  }
}

}  // namespace
}  // namespace holdfast
