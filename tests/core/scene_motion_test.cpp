#include "core/frame/scene_motion.h"

#include <gtest/gtest.h>

#include "core/frame/conventions.h"
#include "core/motion/surface_motion.h"
#include "tests/core/expect_input_error.h"
#include "tests/core/small_world.h"

namespace holdfast {
namespace {

constexpr int kWidth = 320, kHeight = 180;

Frame frame_of(const Camera& camera, TransformTable objects = {}) {
  Frame frame;
  frame.camera = camera;
  frame.objects = std::move(objects);
  return frame;
}

void advance(SceneMotion& scene, const Frame& frame) { scene.advance(frame, kWidth, kHeight, {}); }

/// The pixel of a world point by the camera's own matrices.
glm::dvec2 pixel_of(const Camera& camera, const glm::dvec3& world) {
  return pixel_from_clip(camera.clip_from_view * (camera.view_from_world * glm::dvec4(world, 1)),
                         double{kWidth}, double{kHeight});
}

glm::dvec3 carried(const glm::dmat4& before, const glm::dmat4& now, const glm::dvec3& point) {
  return glm::dvec3(before * (glm::inverse(now) * glm::dvec4(point, 1)));
}

TEST(SceneMotion, StaticWorldUnderAStillCameraIsAtRest) {
  SceneMotion scene;
  const Frame frame = frame_of(test::perspective_camera(kWidth, kHeight, {1, 2, 3}),
                               {{4, glm::translate(glm::dmat4(1), {1, 0, 0})}});
  advance(scene, frame);
  EXPECT_FALSE(scene.geometry_at_rest());  // nothing is known of the frame before the first
  advance(scene, frame);
  EXPECT_TRUE(scene.geometry_at_rest());
  EXPECT_EQ(scene.slot_of(4), 0);
  EXPECT_TRUE(scene.object(0).at_rest);
  const auto pixel = surface_previous_pixel(scene.object(0), glm::vec3(0.1f, 0.2f, -4.0f));
  const auto now = project(glm::mat4(scene.view().pixel_from_relative), glm::vec3(0.1f, 0.2f, -4));
  EXPECT_NEAR(pixel.x, now.x, 1e-4f);
  EXPECT_NEAR(pixel.y, now.y, 1e-4f);
}

TEST(SceneMotion, RemembersOnlySoManyObjectsAndForgetsThoseListedLongestAgo) {
  constexpr std::uint32_t kEach = 20000, kFrames = 12, kFaithful = 4000000000u;
  const Camera camera = test::perspective_camera(kWidth, kHeight);
  SceneMotion scene;
  for (std::uint32_t t = 0; t < kFrames; ++t) {
    TransformTable objects;
    for (std::uint32_t k = 0; k < kEach; ++k) objects[1 + t * kEach + k] = glm::dmat4(1);
    objects[kFaithful] = glm::translate(glm::dmat4(1), {0.1 * t, 0.0, 0.0});
    advance(scene, frame_of(camera, objects));
    EXPECT_LE(scene.remembered_objects(), SceneMotion::kMostObjects);
    if (t > 0) {
      EXPECT_EQ(scene.slot_count(), 2) << "what is listed in every frame is known";
    }
  }
  EXPECT_GT(scene.remembered_objects(), SceneMotion::kMostObjects / 2);
  // The last frame's objects are known, so that they can move; the first one's are new again.
  const std::uint32_t known = kFrames * kEach, forgotten = 1;
  const glm::dmat4 elsewhere = glm::translate(glm::dmat4(1), {0.0, 1.0, 0.0});
  advance(scene, frame_of(camera, {{known, elsewhere}, {forgotten, elsewhere}}));
  EXPECT_NE(scene.slot_of(known), 0);
  EXPECT_FALSE(scene.object(scene.slot_of(known)).appeared);
  EXPECT_TRUE(scene.object(scene.slot_of(forgotten)).appeared);
}

TEST(SceneMotion, AFrameMayListMoreObjectsThanAreRemembered) {
  const Camera camera = test::perspective_camera(kWidth, kHeight);
  TransformTable objects;
  for (std::uint32_t k = 1; k <= SceneMotion::kMostObjects + 10; ++k) objects[k] = glm::dmat4(1);
  SceneMotion scene;
  advance(scene, frame_of(camera, objects));
  for (auto& [id, matrix] : objects) matrix[3].x = 1;
  advance(scene, frame_of(camera, objects));
  EXPECT_EQ(scene.slot_count(), static_cast<int>(objects.size()) + 1);
}

TEST(SceneMotion, MotionIsPreviousMinusCurrent) {
  SceneMotion scene;
  advance(scene, frame_of(test::perspective_camera(kWidth, kHeight, {0, 0, 0})));
  advance(scene, frame_of(test::perspective_camera(kWidth, kHeight, {0.1, 0, 0})));
  // The camera went right, so that things went left in the image: they were further right before.
  const auto before = surface_previous_pixel(scene.object(0), glm::vec3(0, 0, -5));
  EXPECT_GT(before.x - 0.5f * kWidth, 1.0f);
  EXPECT_NEAR(before.y, 0.5f * kHeight, 1e-3f);
  EXPECT_FALSE(scene.object(0).at_rest);
}

// Float matrices that act on points metres away: 1e-6 of 320 px.
TEST(SceneMotion, MovedObjectsWereWhereTheirTransformsSay) {
  test::Random random(7);
  for (int trial = 0; trial < 50; ++trial) {
    const Camera before = test::perspective_camera(kWidth, kHeight, random.in_box(1));
    const Camera now = test::perspective_camera(kWidth, kHeight, random.in_box(1));
    const glm::dmat4 t0 = test::random_rigid(random, 3, 2);
    const glm::dmat4 still_t = test::random_rigid(random, 3, 2);
    // A large transform between the frames, but a point that stays in view of both.
    const glm::dmat4 now_t = test::random_rigid(random, 0.1, 0.2) * t0;
    SceneMotion scene;
    advance(scene, frame_of(before, {{9, t0}, {11, still_t}}));
    advance(scene, frame_of(now, {{9, now_t}}));
    ASSERT_GT(scene.slot_of(9), 0);
    EXPECT_EQ(scene.slot_of(11), 0) << "an omitted object has not moved";
    EXPECT_EQ(scene.slot_of(12345), 0) << "an object in no table is static";
    const glm::dvec3 world = glm::dvec3(0, 0, -6) + random.in_box(1);
    const glm::vec3 relative(world - scene.view().origin);
    const auto moved = surface_previous_pixel(scene.object(scene.slot_of(9)), relative);
    const glm::dvec2 expected = pixel_of(before, carried(t0, now_t, world));
    EXPECT_NEAR(moved.x, expected.x, 2e-3);
    EXPECT_NEAR(moved.y, expected.y, 2e-3);
    const auto still = surface_previous_pixel(scene.object(scene.slot_of(11)), relative);
    const glm::dvec2 expected_still = pixel_of(before, world);
    EXPECT_NEAR(still.x, expected_still.x, 2e-3);
    EXPECT_NEAR(still.y, expected_still.y, 2e-3);
  }
}

TEST(SceneMotion, NormalsTurnWithTheirObject) {
  SceneMotion scene;
  const Camera camera = test::perspective_camera(kWidth, kHeight);
  const glm::dmat4 quarter = glm::rotate(glm::dmat4(1), 1.57079632679489662, glm::dvec3(0, 0, 1));
  advance(scene, frame_of(camera, {{1, glm::dmat4(1)}}));
  advance(scene, frame_of(camera, {{1, glm::scale(quarter, glm::dvec3(1, 3, 1))}}));
  const glm::vec3 n = glm::normalize(scene.object(scene.slot_of(1)).rotate * glm::vec3(0, 1, 0));
  EXPECT_NEAR(n.x, 1.0f, 1e-6f);  // +Y now was +X a quarter turn ago
}

TEST(SceneMotion, ObjectOmittedAfterMovingStandsStill) {
  SceneMotion scene;
  const Camera camera = test::perspective_camera(kWidth, kHeight);
  const glm::dmat4 shifted = glm::translate(glm::dmat4(1), {0.5, 0, 0});
  advance(scene, frame_of(camera, {{3, glm::dmat4(1)}}));
  advance(scene, frame_of(camera, {{3, shifted}}));
  EXPECT_GT(scene.slot_of(3), 0);
  advance(scene, frame_of(camera));
  EXPECT_EQ(scene.slot_of(3), 0);
  EXPECT_TRUE(scene.geometry_at_rest());
  // It is still remembered where it stands: sending the same transform again is no motion either.
  advance(scene, frame_of(camera, {{3, shifted}}));
  EXPECT_EQ(scene.slot_of(3), 0);
}

TEST(SceneMotion, ObjectWithASingularTransformCannotBeTraced) {
  SceneMotion scene;
  const Camera camera = test::perspective_camera(kWidth, kHeight);
  advance(scene, frame_of(camera, {{3, glm::dmat4(1)}}));
  advance(scene, frame_of(camera, {{3, glm::scale(glm::dmat4(1), glm::dvec3(1, 0, 1))}}));
  ASSERT_GT(scene.slot_of(3), 0);
  EXPECT_FALSE(scene.object(scene.slot_of(3)).traceable);
  EXPECT_TRUE(scene.object(0).traceable);
}

TEST(SceneMotion, BadFramesAreRejectedAndChangeNothing) {
  const std::vector<Light> lights{{5, LightShape::kPoint, 0, 0, 0}};
  const Camera camera = test::perspective_camera(kWidth, kHeight);
  const auto placed = [&](double x) {
    Frame frame = frame_of(camera, {{1, glm::translate(glm::dmat4(1), {x, 0, 0})}});
    frame.lights[5] = glm::translate(glm::dmat4(1), {0, x, 0});
    return frame;
  };
  SceneMotion scene;
  scene.advance(placed(1), kWidth, kHeight, lights);
  scene.advance(placed(2), kWidth, kHeight, lights);
  const auto send = [&](const Frame& frame) { scene.advance(frame, kWidth, kHeight, lights); };
  Frame bad = placed(7);
  bad.lights[6] = glm::dmat4(1);
  test::expect_input_error([&] { send(bad); }, "light 6", "light of the session", "unknown");
  bad = placed(7);
  bad.objects[1][2][2] = std::nan("");
  test::expect_input_error([&] { send(bad); }, "transform of object 1", "finite", "nan");
  bad = placed(7);
  bad.lights[5][3][0] = HUGE_VAL;
  test::expect_input_error([&] { send(bad); }, "transform of light 5", "finite", "inf");
  bad = placed(7);
  bad.camera.view_from_world = glm::dmat4(0);
  test::expect_input_error([&] { send(bad); }, "camera viewFromWorld", "invertible", "0");

  EXPECT_GT(scene.slot_of(1), 0);
  EXPECT_FALSE(scene.light(5).at_rest);
  EXPECT_EQ(scene.light(5).relative_from_light[3], glm::dvec4(0, 2, 0, 1));
  EXPECT_EQ(scene.light(5).previous_relative_from_light[3], glm::dvec4(0, 1, 0, 1));
  scene.advance(placed(2), kWidth, kHeight, lights);
  EXPECT_TRUE(scene.geometry_at_rest());
  EXPECT_TRUE(scene.light(5).at_rest);
}

TEST(SceneMotion, ALightOrObjectThatAppearsIsNoRest) {
  const std::vector<Light> lights{{5, LightShape::kPoint, 0, 0, 0}};
  SceneMotion scene;
  Frame frame = frame_of(test::perspective_camera(kWidth, kHeight, {0, 0, 0}));
  const auto at_rest_after = [&] {
    scene.advance(frame, kWidth, kHeight, lights);
    return scene.at_rest();
  };
  at_rest_after();
  EXPECT_TRUE(at_rest_after());
  frame.lights[5] = glm::translate(glm::dmat4(1), {0, 2, 0});
  EXPECT_FALSE(at_rest_after());
  EXPECT_TRUE(at_rest_after());  // sent again, but there already
  frame.objects[3] = glm::dmat4(1);
  EXPECT_FALSE(at_rest_after());
  EXPECT_TRUE(at_rest_after());
}

TEST(SceneMotion, AnObjectHasAppearedInTheFrameThatListsItFirstAndStandsStillThere) {
  SceneMotion scene;
  Frame frame = frame_of(test::perspective_camera(kWidth, kHeight, {0, 0, 0}));
  frame.objects[2] = glm::dmat4(1);
  const auto appeared = [&](std::uint32_t id) {
    const int slot = scene.slot_of(id);
    return slot != 0 && scene.object(slot).appeared;
  };
  scene.advance(frame, kWidth, kHeight, {});
  EXPECT_FALSE(appeared(2)) << "before the first frame nothing is known of anything";
  frame.objects[3] = glm::translate(glm::dmat4(1), {0, 2, 0});
  scene.advance(frame, kWidth, kHeight, {});
  EXPECT_TRUE(appeared(3));
  EXPECT_FALSE(appeared(2));
  EXPECT_TRUE(scene.object(scene.slot_of(3)).at_rest && scene.geometry_at_rest());
  frame.objects[3] = glm::translate(glm::dmat4(1), {0, 3, 0});
  scene.advance(frame, kWidth, kHeight, {});
  EXPECT_FALSE(appeared(3));
  EXPECT_FALSE(scene.geometry_at_rest());
}

TEST(SceneMotion, LightsAreRelativeToTheCameraOfTheirFrame) {
  const std::vector<Light> lights{{5, LightShape::kPoint, 0, 0, 0}};
  SceneMotion scene;
  Frame frame = frame_of(test::perspective_camera(kWidth, kHeight, {10, 0, 0}));
  frame.lights[5] = glm::translate(glm::dmat4(1), {11, 0, 0});
  scene.advance(frame, kWidth, kHeight, lights);
  frame.camera = test::perspective_camera(kWidth, kHeight, {0, 3, 0});
  frame.lights[5] = glm::translate(glm::dmat4(1), {0, 5, 0});
  scene.advance(frame, kWidth, kHeight, lights);
  const auto motion = scene.light(5);
  EXPECT_LT(glm::distance(motion.relative_from_light[3], glm::dvec4(0, 2, 0, 1)), 1e-9);
  EXPECT_LT(glm::distance(motion.previous_relative_from_light[3], glm::dvec4(1, 0, 0, 1)), 1e-9);
}

TEST(SceneMotion, ResetForgetsThePast) {
  SceneMotion scene;
  const Camera camera = test::perspective_camera(kWidth, kHeight);
  advance(scene, frame_of(camera, {{3, glm::dmat4(1)}}));
  scene.reset();
  advance(scene, frame_of(camera, {{3, glm::translate(glm::dmat4(1), {0.5, 0, 0})}}));
  EXPECT_EQ(scene.slot_of(3), 0);
  EXPECT_FALSE(scene.object(0).at_rest);
}

// All matrices are composed in double, so that only points near the camera meet a float.
TEST(SceneMotion, MotionIsPreciseFarFromTheWorldsOrigin) {
  const glm::dvec3 far(1e7, -2e7, 3e6);
  const Camera before = test::perspective_camera(kWidth, kHeight, far);
  const Camera now = test::perspective_camera(kWidth, kHeight, far + glm::dvec3(0.1, 0.05, -0.2));
  const glm::dvec3 centre = far + glm::dvec3(0, 0, -5);
  const glm::dmat4 t0 = glm::translate(glm::dmat4(1), centre);
  const glm::dmat4 t1 = glm::rotate(glm::translate(glm::dmat4(1), centre + glm::dvec3(0.1, 0, 0)),
                                    0.05, glm::dvec3(0, 1, 0));
  SceneMotion scene;
  advance(scene, frame_of(before, {{2, t0}}));
  advance(scene, frame_of(now, {{2, t1}}));
  test::Random random(5);
  for (int k = 0; k < 100; ++k) {
    const glm::dvec3 local = random.in_box(1);
    const glm::dvec3 world(t1 * glm::dvec4(local, 1));
    const auto pixel = surface_previous_pixel(scene.object(scene.slot_of(2)),
                                              glm::vec3(world - scene.view().origin));
    const glm::dvec2 expected = pixel_of(before, glm::dvec3(t0 * glm::dvec4(local, 1)));
    EXPECT_NEAR(pixel.x, expected.x, 1e-2);
    EXPECT_NEAR(pixel.y, expected.y, 1e-2);
  }
}

// What prev_pixel leads back, next_pixel leads on.
TEST(SceneMotion, NextPixelIsWhereAPointOfThePreviousFrameIsNow) {
  test::Random random(8);
  for (int trial = 0; trial < 50; ++trial) {
    const Camera before =
        test::perspective_camera(kWidth, kHeight, random.in_box(1), {0.05, 0, -1});
    const Camera now =
        test::perspective_camera(kWidth, kHeight, random.in_box(1), {-0.05, 0.1, -1});
    const glm::dmat4 t0 = test::random_rigid(random, 3, 2);
    const glm::dmat4 t1 = test::random_rigid(random, 0.1, 0.2) * t0;
    SceneMotion scene;
    advance(scene, frame_of(before, {{9, t0}}));
    advance(scene, frame_of(now, {{9, t1}}));
    const glm::dvec3 world = glm::dvec3(0, 0, -6) + random.in_box(1);
    const glm::vec3 relative(world - scene.previous_view().origin);
    const auto moved = project(scene.object(scene.slot_of(9)).next_pixel, relative);
    const glm::dvec2 expected = pixel_of(now, carried(t1, t0, world));
    EXPECT_NEAR(moved.x, expected.x, 2e-3);
    EXPECT_NEAR(moved.y, expected.y, 2e-3);
    const auto still = project(scene.object(0).next_pixel, relative);
    const glm::dvec2 expected_still = pixel_of(now, world);
    EXPECT_NEAR(still.x, expected_still.x, 2e-3);
    EXPECT_NEAR(still.y, expected_still.y, 2e-3);
  }
}

TEST(SceneMotion, IsAtRestOnlyIfTheLightsAreToo) {
  const std::vector<Light> lights{{5, LightShape::kPoint, 0, 0, 0}};
  SceneMotion scene;
  const auto send = [&](double object, double light, double camera) {
    Frame frame = frame_of(test::perspective_camera(kWidth, kHeight, {camera, 0, 0}),
                           {{1, glm::translate(glm::dmat4(1), {object, 0, 0})}});
    frame.lights[5] = glm::translate(glm::dmat4(1), {0, light, 0});
    scene.advance(frame, kWidth, kHeight, lights);
    return scene.at_rest();
  };
  EXPECT_FALSE(send(1, 1, 0)) << "nothing is known of the frame before the first";
  EXPECT_TRUE(send(1, 1, 0));
  EXPECT_FALSE(send(1, 2, 0)) << "the light moves";
  EXPECT_TRUE(scene.geometry_at_rest());
  EXPECT_TRUE(send(1, 2, 0));
  EXPECT_FALSE(send(2, 2, 0)) << "the object moves";
  EXPECT_TRUE(send(2, 2, 0));
  EXPECT_FALSE(send(2, 2, 1)) << "the camera moves";
  EXPECT_TRUE(send(2, 2, 1));
}

}  // namespace
}  // namespace holdfast
