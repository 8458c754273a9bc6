#include "core/frame/view_geometry.h"

#include <gtest/gtest.h>

#include "core/frame/conventions.h"
#include "tests/core/expect_input_error.h"
#include "tests/core/small_world.h"

namespace holdfast {
namespace {

constexpr int kWidth = 320, kHeight = 180;

Camera off_centre_camera() {
  Camera camera = test::perspective_camera(kWidth, kHeight, {3, -2, 5}, {0.4, -0.3, -1});
  camera.clip_from_view = glm::frustum(-0.03, 0.09, -0.05, 0.02, 0.1, 100.0);
  return camera;
}

Camera off_centre_orthographic_camera() {
  Camera camera = test::orthographic_camera(kWidth, kHeight, {1, 2, 3}, {-1, 0.2, 0.5});
  camera.clip_from_view = glm::ortho(-1.0, 5.0, -2.0, 1.0, 0.1, 100.0);
  return camera;
}

std::vector<Camera> cameras() {
  return {test::perspective_camera(kWidth, kHeight, {1, 2, 3}, {-1, 0.2, 0.5}), off_centre_camera(),
          test::orthographic_camera(kWidth, kHeight, {1, 2, 3}, {-1, 0.2, 0.5}),
          off_centre_orthographic_camera()};
}

TEST(ViewGeometry, PositionsProjectBackToTheirPixelAndDepth) {
  for (const Camera& camera : cameras()) {
    const ViewGeometry view(camera, kWidth, kHeight);
    test::Random random(1);
    for (int k = 0; k < 200; ++k) {
      const double px = random.uniform(-10, kWidth + 10), py = random.uniform(-10, kHeight + 10);
      const double depth = random.uniform(0.2, 90);
      const auto back = project(view.pixel_from_relative, view.rays.position(px, py, depth));
      ASSERT_TRUE(back.in_front);
      EXPECT_NEAR(back.x, px, 1e-9);
      EXPECT_NEAR(back.y, py, 1e-9);
      EXPECT_NEAR(back.depth, depth, 1e-9);
    }
  }
}

// The camera's own matrices, applied one after the other.
TEST(ViewGeometry, PositionsAgreeWithTheCameraMatrices) {
  for (const Camera& camera : cameras()) {
    const ViewGeometry view(camera, kWidth, kHeight);
    test::Random random(2);
    for (int k = 0; k < 200; ++k) {
      const double px = random.uniform(0, kWidth), py = random.uniform(0, kHeight);
      const double depth = random.uniform(0.2, 90);
      const glm::dvec3 world = view.origin + view.rays.position(px, py, depth);
      const glm::dvec4 in_view = camera.view_from_world * glm::dvec4(world, 1);
      const auto pixel =
          pixel_from_clip(camera.clip_from_view * in_view, double{kWidth}, double{kHeight});
      EXPECT_NEAR(-in_view.z, depth, 1e-9);
      EXPECT_NEAR(pixel.x, px, 1e-9);
      EXPECT_NEAR(pixel.y, py, 1e-9);
    }
  }
}

// A float holds camera-relative coordinates to 1e-7 of the distance, 320 pixels to 4e-5 px; world
// coordinates 1e7 m out would be off by whole metres.
TEST(ViewGeometry, FloatKeepsPixelsFarFromTheWorldsOrigin) {
  const Camera camera =
      test::perspective_camera(kWidth, kHeight, {1e7, -1e7, 1e7}, {-0.3, 0.2, -1});
  const ViewGeometry view(camera, kWidth, kHeight);
  const PixelRays<float> rays = view.rays.cast<float>();
  const glm::mat4 pixel_from_relative(view.pixel_from_relative);
  test::Random random(3);
  for (int k = 0; k < 500; ++k) {
    const float px = random.real(0, kWidth), py = random.real(0, kHeight);
    const float depth = random.real(0.2f, 2000.0f);
    const auto back = project(pixel_from_relative, rays.position(px, py, depth));
    EXPECT_NEAR(back.x, px, 1e-2f);
    EXPECT_NEAR(back.y, py, 1e-2f);
    EXPECT_NEAR(back.depth, depth, 1e-5f * depth);
  }
}

TEST(ViewGeometry, PixelAngleIsTheFootprintAtOneMetre) {
  const ViewGeometry view(test::perspective_camera(200, 100), 200, 100);
  EXPECT_NEAR(view.pixel_angle, 2 * std::tan(0.45) / 100, 1e-12);
  const ViewGeometry flat(test::orthographic_camera(200, 100), 200, 100);
  EXPECT_NEAR(flat.pixel_angle, 4.0 / 100, 1e-12);
}

TEST(ViewGeometry, SingularOrNonFiniteCamerasAreRejectedByName) {
  const Camera good = test::perspective_camera(kWidth, kHeight);
  const auto make = [](const Camera& camera) { return ViewGeometry(camera, kWidth, kHeight); };
  Camera bad = good;
  bad.view_from_world[1] = bad.view_from_world[0];
  test::expect_input_error([&] { make(bad); }, "camera viewFromWorld", "invertible", "0");
  bad = good;
  bad.clip_from_view = glm::dmat4(0);
  test::expect_input_error([&] { make(bad); }, "camera clipFromView", "invertible", "0");
  bad = good;
  bad.view_from_world[3][1] = std::nan("");
  test::expect_input_error([&] { make(bad); }, "camera viewFromWorld", "finite", "nan");
  bad = good;
  bad.clip_from_view[0][0] = HUGE_VAL;
  test::expect_input_error([&] { make(bad); }, "camera clipFromView", "finite", "inf");
}

TEST(ViewGeometry, DirectionsProjectToTheLimitOfPointsFarAlongThem) {
  for (const Camera& camera : {cameras()[0], cameras()[1]}) {
    const ViewGeometry view(camera, kWidth, kHeight);
    test::Random random(4);
    for (int k = 0; k < 100; ++k) {
      const glm::dvec3 along =
          view.rays.position(random.uniform(0, kWidth), random.uniform(0, kHeight), 1.0);
      const auto direction = project(view.pixel_from_relative, glm::dvec4(along, 0));
      const auto far = project(view.pixel_from_relative, 1e9 * along + random.in_box(1));
      ASSERT_TRUE(direction.in_front);
      EXPECT_NEAR(direction.x, far.x, 1e-5);
      EXPECT_NEAR(direction.y, far.y, 1e-5);
      const auto back = project(view.pixel_from_relative, glm::dvec4(-along, 0));
      EXPECT_FALSE(back.in_front);
      EXPECT_EQ(back.x, 0.0);
    }
  }
}

TEST(ViewGeometry, WhatIsBehindOrBeyondAllPixelsProjectsNowhere) {
  const ViewGeometry view(test::perspective_camera(kWidth, kHeight), kWidth, kHeight);
  const glm::mat4 pixel(view.pixel_from_relative);
  for (const glm::vec4 bad :
       {glm::vec4(0, 0, 1, 1), glm::vec4(0, 0, 0, 1), glm::vec4(1e30f, 0, -1e-3f, 1),
        glm::vec4(1, 0, -1e-12f, 0), glm::vec4(test::kNaN, 0, -1, 1),
        glm::vec4(test::kInf, 0, -1, 1), glm::vec4(3e38f, 3e38f, -3e38f, 1) * 10.0f}) {
    const auto point = project(pixel, bad);
    EXPECT_FALSE(point.in_front) << bad.x << ' ' << bad.z;
    EXPECT_EQ(point.x, 0.0f);
    EXPECT_EQ(point.y, 0.0f);
  }
}

}  // namespace
}  // namespace holdfast
