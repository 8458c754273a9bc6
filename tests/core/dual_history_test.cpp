#include "core/history/dual_history.h"

#include <algorithm>
#include <utility>

#include <gtest/gtest.h>

#include "tests/core/two_frames.h"

namespace holdfast {
namespace {

constexpr int kWidth = 96, kHeight = 48;
constexpr std::uint32_t kWall = 1, kOccluder = 2;

/// Pixels per metre on a card at `depth`, for the camera at the origin.
double pixels_per_metre(double depth) { return kHeight / (2 * std::tan(0.45) * depth); }

test::Card wall_card() {
  return {kWall, {-50, -50}, {50, 50}, glm::translate(glm::dmat4(1), {0, 0, -10})};
}
test::Card bar(double from, double to) {
  return {kOccluder, {from, -1}, {to, 1}, glm::translate(glm::dmat4(1), {0, 0, -5})};
}

/// Bars before a wall; `shift_px` is what the bars move to the right.
struct Occlusion : test::TwoFrames {
  SurfaceHistory surface{kWidth, kHeight};
  EffectHistory dual{kWidth, kHeight};

  Occlusion(std::vector<test::Card> bars, double shift_px) : TwoFrames(kWidth, kHeight, bars) {
    before.cards.push_back(wall_card());
    scene.cards.push_back(wall_card());
    before.objects[kOccluder] = glm::dmat4(1);
    scene.objects[kOccluder] =
        glm::translate(glm::dmat4(1), {shift_px / pixels_per_metre(5), 0.0, 0.0});
  }
  void run() {
    trace_surface_history(frames(), nullptr, surface);
    trace_dual_history(frames(), surface, dual);
  }
  /// Wall now, bars one frame ago: what the bars have laid open.
  bool is_laid_open(int x, int y) const {
    return now.id[0].at(x, y) == kWall && previous.id[0].at(x, y) == kOccluder;
  }
  bool has_dual(int x, int y) const { return dual.taps[0].at(x, y).any(); }
};

/// The mean id of what taps read, which is an id where they read one object.
float id_at(const Guides& guides, const Taps& taps) {
  Channels<float> ids(kWidth, kHeight, 1);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) ids[0].at(x, y) = static_cast<float>(guides.id[0].at(x, y));
  return gather(std::as_const(ids)[0], taps);
}

TEST(DualHistory, OfAMovingOccluderLeadsFromBackgroundToBackground) {
  Occlusion o({bar(-1, 1)}, 6);
  o.render();
  o.run();
  int laid_open = 0;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      if (!o.is_laid_open(x, y) || o.surface.taps[0].at(x, y).any()) continue;
      ASSERT_TRUE(o.has_dual(x, y)) << x << ", " << y;
      EXPECT_NEAR(id_at(o.previous, o.dual.taps[0].at(x, y)), float{kWall}, 1e-6f);
      EXPECT_NEAR(o.dual.motion[0].at(x, y), -6, 1e-3f);
      EXPECT_NEAR(o.dual.motion[1].at(x, y), 0, 1e-3f);
      EXPECT_EQ(o.dual.motion[2].at(x, y), 1.0f);
      ++laid_open;
    }
  EXPECT_GT(laid_open, 50);
}

TEST(SurfaceHistory, BlocksAreCompleteWhereAllPixelsHaveTaps) {
  for (const double shift_px : {0.0, 6.0}) {
    Occlusion o({bar(-1, 1)}, shift_px);
    o.render();
    o.run();
    int complete = 0, others = 0;
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; x += SurfaceHistory::kBlock) {
        const int count = std::min(SurfaceHistory::kBlock, kWidth - x);
        const Taps* taps = o.surface.taps[0].row(y) + x;
        const bool all =
            std::all_of(taps, taps + count, [](const Taps& each) { return each.any(); });
        ASSERT_EQ(o.surface.all_have_taps(x, y, count), all) << x << ", " << y;
        ++(all ? complete : others);
      }
    EXPECT_GT(complete, 10);
    EXPECT_EQ(others > 0, shift_px > 0.0);
    EXPECT_EQ(o.surface.all_have_taps(0, 0, kWidth),
              o.surface.all_have_taps(0, 0, 1) && o.surface.all_have_taps(kWidth - 1, 0, 1));
  }
}

TEST(DualHistory, IsGivenOnlyWhereTheSurfaceVectorFails) {
  Occlusion o({bar(-1, 1)}, 6);
  o.render();
  o.run();
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      if (!o.surface.taps[0].at(x, y).any()) continue;
      ASSERT_FALSE(o.has_dual(x, y));
      for (int c = 0; c < 3; ++c) ASSERT_EQ(o.dual.motion[c].at(x, y), 0.0f);
    }
}

TEST(DualHistory, FollowsTheOccluderUnderAMovingCamera) {
  Occlusion o({bar(-1, 1)}, 5);
  const double step = 0.15;
  o.camera = test::perspective_camera(kWidth, kHeight, {step, 0, 0});
  o.render();
  o.run();
  // y is where the wall's point was; the occluder there has gone by its own motion less the
  // camera's: x' = y + x - z = x + (wall's motion) - (occluder's).
  const double wall_px = step * pixels_per_metre(10);
  const double occluder_px = 5 - step * pixels_per_metre(5);
  int found = 0;
  for (int y = 4; y < kHeight - 4; ++y)
    for (int x = 0; x < kWidth; ++x) {
      if (o.now.id[0].at(x, y) != kWall || !o.has_dual(x, y)) continue;
      const float from = static_cast<float>(x) + 0.5f + o.surface.motion[0].at(x, y);
      if (o.previous.id[0].at(static_cast<int>(from), y) != kOccluder) continue;
      EXPECT_NEAR(o.dual.motion[0].at(x, y), wall_px - (occluder_px + wall_px), 1e-2) << x;
      ++found;
    }
  EXPECT_GT(found, 10);
}

// What moves on was joined to a part that is gone: beside it there was no background, not even
// where that part lay flush with the wall.
TEST(DualHistory, ThatLeadsToTheOccluderAgainIsNone) {
  const double pixel = 1 / pixels_per_metre(5);
  for (const bool flush : {false, true}) {
    Occlusion o({bar(0, 20 * pixel)}, 10);
    o.before.cards.push_back(bar(-15 * pixel, 0));
    o.render();
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth / 2; ++x)
        if (flush && o.previous.id[0].at(x, y) == kOccluder)
          test::set_pixel(o.previous, x, y, 10.0f, {0, 0, 1}, kOccluder);
    o.run();
    for (int x = kWidth / 2; x < kWidth / 2 + 9; ++x) {
      ASSERT_TRUE(o.is_laid_open(x, kHeight / 2)) << x;
      EXPECT_FALSE(o.surface.taps[0].at(x, kHeight / 2).any());
      EXPECT_FALSE(o.has_dual(x, kHeight / 2)) << x << (flush ? " flush" : "");
    }
  }
}

TEST(DualHistory, ThatLeadsOffScreenIsNone) {
  // A bar at the left border, which moves inside by more than the border's own width.
  const double left = -0.5 * kWidth / pixels_per_metre(5);
  Occlusion o({bar(left + 2 / pixels_per_metre(5), left + 30 / pixels_per_metre(5))}, 12);
  o.render();
  o.run();
  int off_screen = 0;
  for (int x = 2; x < 10; ++x)
    if (o.is_laid_open(x, kHeight / 2)) {
      EXPECT_FALSE(o.has_dual(x, kHeight / 2)) << x;
      ++off_screen;
    }
  EXPECT_GE(off_screen, 5);
}

TEST(DualHistory, OfAnotherSurfaceThanTheReceiverIsNone) {
  Occlusion o({bar(-1, 1)}, 6);
  o.render();
  for (int y = 0; y < kHeight; ++y)  // what was beside the bar was nearer and faced elsewhere
    for (int x = 0; x < kWidth; ++x)
      if (o.previous.id[0].at(x, y) == kWall)
        test::set_pixel(o.previous, x, y, 7.0f, glm::normalize(glm::vec3(1, 0, 1)), kWall);
  o.run();
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) ASSERT_FALSE(o.has_dual(x, y));
}

TEST(DualHistory, TakesAnotherObjectOnTheReceiversPlane) {
  Occlusion o({bar(-1, 1)}, 6);
  o.render();
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      if (o.previous.id[0].at(x, y) == kWall) o.previous.id[0].at(x, y) = 9;
  o.run();
  int found = 0;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) found += o.is_laid_open(x, y) && o.has_dual(x, y) ? 1 : 0;
  EXPECT_GT(found, 50);
}

TEST(DualHistory, FollowsGivenMotionVectorsWhereTheClientSendsThem) {
  Occlusion o({bar(-1, 1)}, 6);
  o.render();
  o.motion = SceneMotion();  // nothing is known of rigid motion
  Frame still;
  still.camera = o.camera;
  for (int k = 0; k < 2; ++k) o.motion.advance(still, kWidth, kHeight, {});
  o.run();
  const int y = kHeight / 2;
  int laid_open = 0;
  for (int x = 0; x < kWidth; ++x) {
    if (!o.is_laid_open(x, y)) continue;
    EXPECT_FALSE(o.has_dual(x, y)) << "the occluder seems to stand still";
    ++laid_open;
  }
  EXPECT_GE(laid_open, 5);

  o.previous.motion = Channels<float>(kWidth, kHeight, 2);
  for (int row = 0; row < kHeight; ++row)
    for (int x = 0; x < kWidth; ++x)
      if (o.previous.id[0].at(x, row) == kOccluder) o.previous.motion[0].at(x, row) = -6.0f;
  o.run();
  for (int x = 0; x < kWidth; ++x) {
    if (!o.is_laid_open(x, y) || o.surface.taps[0].at(x, y).any()) continue;
    ASSERT_TRUE(o.has_dual(x, y)) << x;
    EXPECT_NEAR(o.dual.motion[0].at(x, y), -6, 1e-4f);
    EXPECT_NEAR(id_at(o.previous, o.dual.taps[0].at(x, y)), float{kWall}, 1e-6f);
  }

  test::fill(o.previous.motion[1], test::kNaN);
  o.run();
  for (int x = 0; x < kWidth; ++x) EXPECT_FALSE(o.has_dual(x, y)) << "not finite is no motion";
}

}  // namespace
}  // namespace holdfast
