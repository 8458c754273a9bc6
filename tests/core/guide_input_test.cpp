#include <gtest/gtest.h>

#include "core/denoiser/frame_input.h"
#include "tests/core/small_world.h"

namespace holdfast {
namespace {

TEST(GuideInput, RoughnessIsKeptInRangeAndRepairsAreCounted) {
  const float in[] = {0.0f,        0.25f,   1.0f,       -0.0f,     -1e-6f,
                      -test::kInf, 1.0001f, test::kInf, test::kNaN};
  const float out[] = {0.0f, 0.25f, 1.0f, 0.0f, 0.0f, 0.0f, 1.0f, 1.0f, 1.0f};
  const int width = 9, height = 3;
  Plane plane({PlaneKind::kRoughness, {}}, width, height);
  for (int x = 0; x < width; ++x) plane.channel(0).at(x, 1) = in[x];
  Guides guides(width, height);
  guides.roughness = Channels<float>(width, height, 1);
  EXPECT_EQ(load_roughness(plane, guides), 5u);
  for (int x = 0; x < width; ++x) {
    EXPECT_EQ(guides.roughness_at(x, 1), out[x]) << in[x];
    EXPECT_EQ(guides.roughness_at(x, 0), 0.0f);
  }
}

TEST(GuideInput, WithoutRoughnessSurfacesAreMirrors) {
  EXPECT_EQ(Guides(4, 4).roughness_at(2, 2), 0.0f);
}

TEST(GuideInput, MotionComesAsItIs) {
  const int width = 5, height = 4;
  Plane plane({PlaneKind::kMotion, {}}, width, height);
  test::Random random(91);
  for (int c = 0; c < 2; ++c) test::fill_random(plane.channel(c), random, -30, 30);
  plane.channel(0).at(3, 2) = test::kNaN;
  plane.channel(1).at(4, 3) = test::kInf;
  Guides guides(width, height);
  guides.motion = Channels<float>(width, height, 2);
  load_motion(plane, guides);
  for (int c = 0; c < 2; ++c)
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        if (c == 0 && x == 3 && y == 2)
          EXPECT_TRUE(std::isnan(guides.motion[c].at(x, y)));
        else
          EXPECT_EQ(guides.motion[c].at(x, y), plane.channel(c).at(x, y));
      }
}

}  // namespace
}  // namespace holdfast
