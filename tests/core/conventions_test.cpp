#include "core/frame/conventions.h"

#include <gtest/gtest.h>

#include "core/frame/light.h"
#include "tests/core/small_world.h"

namespace holdfast {
namespace {

TEST(Conventions, ImageOriginIsTopLeftWithYDown) {
  const auto top_left = pixel_from_clip(glm::dvec4(-1, 1, 0, 1), 640.0, 360.0);
  EXPECT_DOUBLE_EQ(top_left.x, 0.0);
  EXPECT_DOUBLE_EQ(top_left.y, 0.0);
  const auto bottom_right = pixel_from_clip(glm::dvec4(1, -1, 0, 1), 640.0, 360.0);
  EXPECT_DOUBLE_EQ(bottom_right.x, 640.0);
  EXPECT_DOUBLE_EQ(bottom_right.y, 360.0);
}

TEST(Conventions, ClipCoordinatesAreDividedByW) {
  const auto pixel = pixel_from_clip(glm::dvec4(1, 1, 0, 2), 640.0, 360.0);
  EXPECT_DOUBLE_EQ(pixel.x, 480.0);
  EXPECT_DOUBLE_EQ(pixel.y, 90.0);
}

TEST(Conventions, CentreOfTheFirstPixelIsAHalf) {
  const auto ndc = ndc_from_pixel(glm::dvec2(0.5, 0.5), 4.0, 2.0);
  EXPECT_DOUBLE_EQ(ndc.x, -0.75);
  EXPECT_DOUBLE_EQ(ndc.y, 0.5);
  const auto back = pixel_from_clip(glm::dvec4(ndc, 0, 1), 4.0, 2.0);
  EXPECT_DOUBLE_EQ(back.x, 0.5);
  EXPECT_DOUBLE_EQ(back.y, 0.5);
}

TEST(Conventions, CameraLooksDownMinusZWithYUpAndXRight) {
  const ViewGeometry view(test::perspective_camera(100, 100), 100, 100);
  const auto up = project(view.pixel_from_relative, glm::dvec3(0, 1, -5));
  EXPECT_TRUE(up.in_front);
  EXPECT_NEAR(up.x, 50.0, 1e-9);
  EXPECT_LT(up.y, 50.0);
  const auto right = project(view.pixel_from_relative, glm::dvec3(1, 0, -5));
  EXPECT_GT(right.x, 50.0);
  EXPECT_NEAR(right.y, 50.0, 1e-9);
  EXPECT_FALSE(project(view.pixel_from_relative, glm::dvec3(0, 0, 5)).in_front);
}

TEST(Conventions, DepthIsPlanarAndNotTheDistanceToTheCamera) {
  const ViewGeometry view(test::perspective_camera(100, 100), 100, 100);
  EXPECT_NEAR(project(view.pixel_from_relative, glm::dvec3(3, 2, -5)).depth, 5.0, 1e-12);
}

TEST(Conventions, SkyIsInfiniteOrNotPositive) {
  EXPECT_TRUE(is_surface(1e-30f));
  EXPECT_TRUE(is_surface(std::numeric_limits<float>::max()));
  EXPECT_FALSE(is_surface(0.0f));
  EXPECT_FALSE(is_surface(-1.0f));
  EXPECT_FALSE(is_surface(test::kInf));
  EXPECT_FALSE(is_surface(test::kNaN));
}

TEST(Conventions, AlphaIsTheSquareOfTheRoughness) {
  EXPECT_DOUBLE_EQ(ggx_alpha_from_roughness(0.5), 0.25);
}

TEST(Conventions, WrittenMatricesAreRowMajorAndActOnColumns) {
  const double numbers[16] = {1, 0, 0, 10, 0, 1, 0, 20, 0, 0, 1, 30, 0, 0, 0, 1};
  const glm::dmat4 matrix = matrix_from_row_major(numbers);
  EXPECT_EQ(matrix * glm::dvec4(1, 2, 3, 1), glm::dvec4(11, 22, 33, 1));
  double back[16];
  row_major_from_matrix(matrix, back);
  for (int k = 0; k < 16; ++k) EXPECT_EQ(back[k], numbers[k]) << k;
}

TEST(Conventions, JitterMovesNoPixel) {
  Camera camera = test::perspective_camera(64, 32);
  const ViewGeometry plain(camera, 64, 32);
  camera.jitter_px = {0.3, -0.4};
  EXPECT_EQ(plain.pixel_from_relative, ViewGeometry(camera, 64, 32).pixel_from_relative);
}

TEST(LightPoint, OfARectangleSpansItsWidthAndHeight) {
  const Light light{0, LightShape::kRectangle, 4, 2, 0};
  EXPECT_EQ(light_point(light, 0.0, 1.0), glm::dvec4(-2, 1, 0, 1));
  EXPECT_EQ(light_point(light, 0.5, 0.5), glm::dvec4(0, 0, 0, 1));
}

TEST(LightPoint, OfADiskHasItsRadiusAtUOne) {
  const Light light{0, LightShape::kDisk, 0, 0, 3};
  const auto rim = light_point(light, 1.0, 0.25);
  EXPECT_NEAR(rim.x, 0.0, 1e-12);
  EXPECT_NEAR(rim.y, 3.0, 1e-12);
  EXPECT_EQ(light_point(light, 0.25, 0.0), glm::dvec4(1.5, 0, 0, 1));
}

TEST(LightPoint, OfASphereLiesOnItWithThePoleAtUZero) {
  const Light light{0, LightShape::kSphere, 0, 0, 2};
  EXPECT_NEAR(light_point(light, 0.0, 0.3).z, 2.0, 1e-12);
  EXPECT_NEAR(light_point(light, 1.0, 0.3).z, -2.0, 1e-12);
  EXPECT_NEAR(light_point(light, 0.5, 0.5).x, -2.0, 1e-12);
  EXPECT_NEAR(glm::length(glm::dvec3(light_point(light, 0.37, 0.81))), 2.0, 1e-12);
}

TEST(LightPoint, OfAPointIsTheOrigin) {
  EXPECT_EQ(light_point(Light{0, LightShape::kPoint, 0, 0, 0}, 0.9, 0.1), glm::dvec4(0, 0, 0, 1));
}

TEST(LightPoint, OfASunIsAUnitDirectionWithWZero) {
  const Light light{0, LightShape::kDirectional, 0, 0, 0.75};
  EXPECT_EQ(light_point(light, 0.0, 0.2), glm::dvec4(0, 0, 1, 0));
  const auto rim = light_point(light, 1.0, 0.0);  // (3/4, 0, 1) has length 5/4
  EXPECT_NEAR(rim.x, 0.6, 1e-12);
  EXPECT_NEAR(rim.z, 0.8, 1e-12);
  EXPECT_EQ(rim.w, 0.0);
}

}  // namespace
}  // namespace holdfast
