#include "core/history/rest_check.h"

#include <gtest/gtest.h>

#include "tests/core/isa_guard.h"
#include "tests/core/small_world.h"

namespace holdfast {
namespace {

constexpr LightChangeRule kRule{.noticed = true};

/// A wall whose history is 1 everywhere, and frames of noise around `mean`.
struct Wall {
  int width, height;
  Guides guides;
  Channels<float> history, noisy;
  RestCheck check;
  test::Random random{7};

  Wall(int w, int h)
      : width(w),
        height(h),
        guides(test::wall(test::perspective_camera(w, h), w, h)),
        history(w, h, 4),
        noisy(w, h, 3),
        check(w, h) {
    for (int c = 0; c < 3; ++c) test::fill(history[c], 1);
    test::fill(history[3], 64);
  }
  RestFinding look(double mean, int from_x = 0) {
    for (int c = 0; c < 3; ++c)
      for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
          noisy[c].at(x, y) = static_cast<float>((x < from_x ? 1 : mean) * 2 * random.uniform());
    return check.look({guides, history, noisy, 3}, kRule);
  }
};

TEST(RestCheck, FindsNothingInNoiseAlone) {
  for (const auto& [width, height] : {std::pair(1, 1), {17, 5}, {64, 48}, {130, 33}}) {
    Wall wall(width, height);
    for (int i = 0; i < 60; ++i) EXPECT_EQ(wall.look(1), RestFinding::kSame) << width << " " << i;
  }
}

TEST(RestCheck, FindsAChangeOfOneTileInTheFrameOfTheChange) {
  Wall wall(64, 48);
  for (int i = 0; i < 20; ++i) wall.look(1);
  EXPECT_EQ(wall.look(1.4, 48), RestFinding::kSudden);
}

TEST(RestCheck, FindsWhatHidesInTheNoiseOfAFrameWithinTwentyFrames) {
  Wall wall(64, 48);
  for (int i = 0; i < 32; ++i) wall.look(1);
  EXPECT_EQ(wall.look(1.12), RestFinding::kSame);
  int frames = 1;
  while (wall.look(1.12) == RestFinding::kSame && frames < 100) ++frames;
  EXPECT_LT(frames, 20);
}

TEST(RestCheck, LearnsThatFramesWithoutARareBrightSampleAreNoChange) {
  Wall wall(16, 16);
  const auto look = [&](bool bright) {
    for (int c = 0; c < 3; ++c)
      for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 16; ++x)
          wall.noisy[c].at(x, y) = 0.97f + 0.001f * static_cast<float>((x + y) % 2);
    for (int c = 0; c < 3; ++c) wall.noisy[c].at(3, 3) += bright ? 0.06f * 256 : 0.0f;
    return wall.check.look({wall.guides, wall.history, wall.noisy, 3}, kRule);
  };
  EXPECT_EQ(look(false), RestFinding::kSudden) << "nothing is known of the noise";
  for (int i = 0; i < 32; ++i) look(i % 2 == 0);
  for (int i = 0; i < 32; ++i) EXPECT_EQ(look(i % 2 == 0), RestFinding::kSame) << i;
}

TEST(RestCheck, LeavesOutWhatHasNoSurfaceOrNoHistory) {
  Wall wall(32, 16);
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x) {
      if (y < 8)
        wall.guides.depth_normal[0].at(x, y) = 0;
      else
        wall.history[3].at(x, y) = 0;
      for (int c = 0; c < 3; ++c) wall.history[c].at(x, y) = 100;
    }
  for (int i = 0; i < 20; ++i) EXPECT_EQ(wall.look(1), RestFinding::kSame);
}

TEST(RestCheck, FindsTheSameOnEveryInstructionSet) {
  std::vector<std::vector<RestFinding>> found;
  const test::IsaGuard guard;
  for (const Isa isa : available_isas()) {
    select_isa(isa);
    Wall wall(50, 37);
    std::vector<RestFinding>& of = found.emplace_back();
    for (int i = 0; i < 40; ++i) of.push_back(wall.look(1 + 0.02 * i));
  }
  for (const auto& of : found) EXPECT_EQ(of, found.front());
}

}  // namespace
}  // namespace holdfast
