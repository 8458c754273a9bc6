#include "client/measure/motion_picture.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "client/measure/debug_picture.h"
#include "client/measure/false_color.h"
#include "client/measure/label.h"
#include "client/measure/static_motion.h"
#include "core/frame/error.h"

namespace holdfast::measure {
namespace {

Rgb pixel(const Picture& picture, int x, int y) {
  const std::size_t i = static_cast<std::size_t>(y * picture.width + x) * 3;
  return {picture.rgb[i], picture.rgb[i + 1], picture.rgb[i + 2]};
}

Image motion_of(int width, int height, float x, float y) {
  Image motion(width, height, 2);
  std::fill_n(motion.channel(0), motion.pixels(), x);
  std::fill_n(motion.channel(1), motion.pixels(), y);
  return motion;
}

TEST(MotionPicture, ColoursShowDirectionAndLength) {
  EXPECT_EQ(motion_color(0, 0, 4), (Rgb{255, 255, 255}));
  EXPECT_EQ(motion_color(4, 0, 4), (Rgb{255, 0, 0}));
  EXPECT_EQ(motion_color(2, 0, 4), (Rgb{255, 128, 128}));
  EXPECT_EQ(motion_color(-4, 0, 4), (Rgb{0, 255, 255}));
  EXPECT_EQ(motion_color(0, 4, 4), (Rgb{128, 255, 0}));
  EXPECT_EQ(motion_color(0, -4, 4), (Rgb{128, 0, 255}));
  EXPECT_EQ(motion_color(400, 0, 4), motion_color(4, 0, 4));
  EXPECT_EQ(motion_color(std::numeric_limits<double>::quiet_NaN(), 0, 4), (Rgb{0, 0, 0}));
}

TEST(MotionPicture, TheWheelShowsTheColoursOfItsVectors) {
  const Picture wheel = motion_wheel(20);
  EXPECT_EQ(wheel.width, 41);
  EXPECT_EQ(pixel(wheel, 20, 20), motion_color(0, 0, 20));
  EXPECT_EQ(pixel(wheel, 40, 20), motion_color(20, 0, 20));
  EXPECT_EQ(pixel(wheel, 20, 10), motion_color(0, -10, 20));
  EXPECT_EQ(pixel(wheel, 0, 0), (Rgb{0, 0, 0}));
}

TEST(MotionPicture, SkyIsGrey) {
  const Image motion = motion_of(3, 1, 1, 0);
  const Picture picture = motion_picture(motion, {1, 0, 1}, 1);
  EXPECT_EQ(pixel(picture, 0, 0), motion_color(1, 0, 1));
  EXPECT_EQ(pixel(picture, 1, 0), (Rgb{128, 128, 128}));
}

TEST(MotionPicture, ArrowsGoAlongTheMotionFromTheGrid) {
  const Image motion = motion_of(100, 48, 3, 0);
  Picture picture = blank(100, 48);
  for (auto& value : picture.rgb) value = 255;
  draw_motion_arrows(picture, motion, Mask(motion.pixels(), 1), 6, 1);
  for (const int x : {12, 18, 24}) EXPECT_EQ(pixel(picture, x, 12), (Rgb{0, 0, 0})) << x;
  EXPECT_EQ(pixel(picture, 26, 12), (Rgb{255, 255, 255}));
  EXPECT_EQ(pixel(picture, 12, 24), (Rgb{255, 255, 255}));
}

TEST(MotionPicture, TheScaleIsRoundAndLeavesOutFewAndWhatStandsStill) {
  Image motion = motion_of(100, 10, 0, 0);
  for (int i = 0; i < 30; ++i) motion.channel(0)[i] = 1.5f;
  motion.channel(1)[0] = 900;
  EXPECT_DOUBLE_EQ(motion_scale(motion, Mask(motion.pixels(), 1)), 2);
  EXPECT_DOUBLE_EQ(motion_scale(motion, Mask(motion.pixels(), 0)), 0.01);
}

TEST(MotionPicture, ScalesAreOneTwoFiveAndReadAsSuch) {
  EXPECT_EQ(scale_text(round_scale(0.001)), "0.01");
  EXPECT_EQ(scale_text(round_scale(0.03)), "0.05");
  EXPECT_EQ(scale_text(round_scale(0.2)), "0.2");
  EXPECT_EQ(scale_text(round_scale(1)), "1");
  EXPECT_EQ(scale_text(round_scale(3)), "5");
  EXPECT_EQ(scale_text(round_scale(101)), "200");
}

TEST(FalseColor, GrowsLighterFromZeroToTheTop) {
  double before = -1;
  for (int i = 0; i <= 20; ++i) {
    const Rgb c = false_color(i / 20.0);
    const double light = 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2];
    EXPECT_GT(light, before) << i;
    before = light;
  }
  EXPECT_EQ(false_color(2), false_color(1));
}

TEST(StaticMotion, IsTheGivenMotionMinusThatOfTheCamera) {
  Frame frame;
  frame.camera.clip_from_view = glm::dmat4(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, -1, 0, 0, -0.1, 0);
  Plane& depth = frame.planes.add({PlaneKind::kDepth, {}}, 8, 8);
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x) depth.channel(0).at(x, y) = y == 0 ? 0.0f : 2.0f;
  Plane& ids = frame.planes.add({PlaneKind::kObjectId, {}}, 8, 8);
  ids.ids().at(3, 3) = 5;
  SceneMotion scene;
  frame.objects[5] = glm::dmat4(1);
  scene.advance(frame, 8, 8, {});
  frame.camera.view_from_world[3].x = -0.5;  // the camera goes right by 0.5 m: 1 px at 2 m
  frame.objects[5][3].y = 1;                 // the object goes up by 1 m: 2 px
  scene.advance(frame, 8, 8, {});
  const StaticMotion motion = static_motion(frame, scene);
  const std::size_t object = 3 * 8 + 3, other = 3 * 8 + 4;
  EXPECT_EQ(motion.shown[4], 0);
  EXPECT_EQ(motion.shown[object], 1);
  EXPECT_NEAR(motion.at_rest.channel(0)[object], 1, 1e-5);
  const Image difference = motion_difference(motion);
  EXPECT_NEAR(difference.channel(0)[object], 0, 1e-5);
  EXPECT_NEAR(difference.channel(1)[object], 2, 1e-5);
  EXPECT_NEAR(difference.channel(1)[other], 0, 1e-5);

  Plane& given = frame.planes.add({PlaneKind::kMotion, {}}, 8, 8);
  given.channel(0).at(4, 3) = 7;
  EXPECT_NEAR(motion_difference(static_motion(frame, scene)).channel(0)[other], 6, 1e-5);
}

TEST(DebugPicture, ThereAreFourOfEachComponentAndRedIsWhereHistoryIsMissing) {
  const Component glossy{ComponentKind::kGlossy, 0};
  PlaneSet result;
  result.add(component_plane(glossy), 96, 54);
  for (const PlaneKind kind :
       {PlaneKind::kDebugMotion, PlaneKind::kDebugHistory, PlaneKind::kDebugConfidence})
    result.add({kind, glossy}, 96, 54);
  Plane& history = *result.find({PlaneKind::kDebugHistory, glossy});
  history.channel(0).at(0, 0) = 3;
  EXPECT_EQ(debug_components(result), std::vector{glossy});
  const auto pictures = debug_pictures(result, glossy, Mask(96 * 54, 1), "glossy");
  ASSERT_EQ(pictures.size(), 4u);
  EXPECT_EQ(pictures[1].first, "fallback");
  EXPECT_EQ(pixel(pictures[1].second, 5, 5), (Rgb{0, 0, 0}));
  EXPECT_EQ(pixel(pictures[1].second, 15, 5), (Rgb{235, 40, 40}));
  for (const auto& [end, picture] : pictures) EXPECT_EQ(picture.width, 960) << end;
  result.remove({PlaneKind::kDebugHistory, glossy});
  EXPECT_THROW(debug_pictures(result, glossy, Mask(96 * 54, 1), "glossy"), InputError);
}

TEST(Label, DigitsAndMarksAreDistinctFromEachOther) {
  std::vector<std::vector<std::uint8_t>> seen;
  for (const char letter : std::string("0123456789.,-% ol")) {
    Picture picture = blank(kGlyphWidth, kGlyphHeight);
    draw_text(picture, 0, 0, std::string(1, letter), 1);
    for (const auto& other : seen) EXPECT_NE(picture.rgb, other) << letter;
    seen.push_back(picture.rgb);
  }
}

}  // namespace
}  // namespace holdfast::measure
