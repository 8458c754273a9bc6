#include "core/motion/shadow_field.h"

#include <vector>

#include <gtest/gtest.h>

#include "core/frame/conventions.h"
#include "core/motion/shadow_motion.h"
#include "tests/core/small_world.h"

namespace holdfast {
namespace {

constexpr int kWidth = 48, kHeight = 32;
constexpr double kFloorY = -1.0;

/// A floor seen obliquely under one light; a blocker for one pixel, with everything moving between
/// the frames by transforms of its own.
struct World {
  Light light{2, LightShape::kRectangle, 1.0, 0.5, 0};
  Camera camera_before = test::perspective_camera(kWidth, kHeight, {0.1, 0.9, 0.3}, {0, -1, -1});
  Camera camera = test::perspective_camera(kWidth, kHeight, {0, 1, 0}, {0.05, -1, -1});
  glm::dmat4 light_before = glm::translate(glm::dmat4(1), {0.4, 3, -1});
  glm::dmat4 light_now =
      glm::rotate(glm::translate(glm::dmat4(1), {0.1, 3.1, -1.2}), 0.2, glm::dvec3(1, 0, 0.3));
  glm::dmat4 blocker_before = glm::translate(glm::dmat4(1), {0.2, 0, 0});
  glm::dmat4 blocker_now = glm::rotate(glm::dmat4(1), 0.1, glm::dvec3(0, 1, 0));
  glm::dmat4 floor_before = glm::translate(glm::dmat4(1), {0, 0.05, -0.1});
  glm::dmat4 floor_now = glm::dmat4(1);

  SceneMotion scene;
  Guides guides;
  Plane distance{PlaneId::of_light(PlaneKind::kBlockerDistance, 2), kWidth, kHeight};
  Plane sample{PlaneId::of_light(PlaneKind::kLightSample, 2), kWidth, kHeight};
  Plane id{PlaneId::of_light(PlaneKind::kBlockerId, 2), kWidth, kHeight};

  void move() {
    Frame frame;
    frame.camera = camera_before;
    frame.objects = {{1, floor_before}, {2, blocker_before}};
    frame.lights = {{2, light_before}};
    scene.advance(frame, kWidth, kHeight, {light});
    frame.camera = camera;
    frame.objects = {{1, floor_now}, {2, blocker_now}};
    frame.lights = {{2, light_now}};
    scene.advance(frame, kWidth, kHeight, {light});
    guides = test::empty_guides(camera, kWidth, kHeight);
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        const glm::dvec3 start = guides.view.rays.position(x + 0.5, y + 0.5, 0.0);
        const glm::dvec3 ray = guides.view.rays.position(x + 0.5, y + 0.5, 1.0) - start;
        const double depth = (kFloorY - guides.view.origin.y - start.y) / ray.y;
        if (depth > 0) test::set_pixel(guides, x, y, static_cast<float>(depth), {0, 1, 0}, 1);
        distance.channel(0).at(x, y) = test::kInf;
      }
  }

  glm::dvec3 surface(int x, int y) const {
    return guides.view.origin +
           guides.view.rays.position(x + 0.5, y + 0.5, double(guides.depth().at(x, y)));
  }
  /// Blocks the light sample (u, v) of pixel (x, y) at a share of its ray; its world position.
  glm::dvec3 block(int x, int y, float u, float v, double share) {
    const glm::dvec4 l = light_now * light_point(light, double(u), double(v));
    const glm::dvec3 s = surface(x, y), to_light = glm::dvec3(l) - l.w * s;
    distance.channel(0).at(x, y) = static_cast<float>(share * glm::length(to_light));
    sample.channel(0).at(x, y) = u;
    sample.channel(1).at(x, y) = v;
    id.ids().at(x, y) = 2;
    return s + share * to_light;
  }
  /// Where the blocked sample's shadow was, step by step in world space and double.
  glm::dvec2 expected(int x, int y, const glm::dvec3& blocker, float u, float v) const {
    const auto back = [](const glm::dmat4& before, const glm::dmat4& now, const glm::dvec3& p) {
      return glm::dvec3(before * glm::inverse(now) * glm::dvec4(p, 1));
    };
    const glm::dvec4 l = light_before * light_point(light, double(u), double(v));
    const glm::dvec3 b = back(blocker_before, blocker_now, blocker);
    const glm::dvec3 s = back(floor_before, floor_now, surface(x, y));
    const glm::dvec3 ray = l.w * b - glm::dvec3(l);  // the floor keeps its normal +Y
    const glm::dvec3 hit = b + (s.y - b.y) / ray.y * ray;
    return pixel_from_clip(
        camera_before.clip_from_view * (camera_before.view_from_world * glm::dvec4(hit, 1)),
        double{kWidth}, double{kHeight});
  }
  ShadowTracer tracer() const { return {guides, scene, light, {&distance, &sample, &id}}; }
};

TEST(ShadowTracer, FollowsABlockedSampleThroughAllMotions) {
  for (const LightShape shape : {LightShape::kRectangle, LightShape::kDirectional}) {
    World world;
    world.light.shape = shape;
    if (shape == LightShape::kDirectional) {
      world.light.radius = 0.05;
      // Local +Z points to the sun: up, and a little aside.
      world.light_before = glm::rotate(glm::dmat4(1), -1.4, glm::dvec3(1, 0, 0));
      world.light_now = glm::rotate(glm::dmat4(1), -1.3, glm::dvec3(1, 0.1, 0));
    }
    world.move();
    const int x = 24, y = 16;
    const float u = 0.3f, v = 0.8f;
    const glm::dvec3 blocker = world.block(x, y, u, v, 0.4);
    Channels<float> field(kWidth, kHeight, kEffectFieldChannels);
    const ShadowTracer tracer = world.tracer();
    tracer.measure(field, 0);
    EXPECT_EQ(field[kFieldValid].at(x, y), 1.0f);
    EXPECT_EQ(field[kFieldValid].at(x + 1, y), 0.0f);
    EXPECT_NEAR(field[kFieldRatio].at(x, y), 0.4f, 1e-5f);
    const auto pixel = tracer.follow_own(x, y, field[kFieldRatio].at(x, y));
    ASSERT_TRUE(pixel.in_front);
    const glm::dvec2 expected = world.expected(x, y, blocker, u, v);
    EXPECT_NEAR(pixel.x, expected.x, 2e-3);  // float, 48 px
    EXPECT_NEAR(pixel.y, expected.y, 2e-3);
    EXPECT_GT(std::abs(pixel.x - x - 0.5f) + std::abs(pixel.y - y - 0.5f), 0.5f) << "it moved";
  }
}

// A light without height casts a line, a thousand times longer than a pixel: across it the
// precision is that of a pixel, 1/2 over its variance of 1/2 px^2, and along it nearly none.
TEST(ShadowTracer, ALongThinCastKeepsItsPrecisionAcross) {
  World world;
  world.light = {2, LightShape::kRectangle, 2000.0, 0.0, 0};
  world.move();
  for (int x = 4; x < kWidth; x += 5) world.block(x, 20, 0.5f, 0.5f, 0.9);
  Channels<float> field(kWidth, kHeight, kEffectFieldChannels);
  world.tracer().measure(field, 0);
  for (int x = 4; x < kWidth; x += 5) {
    ASSERT_EQ(field[kFieldValid].at(x, 20), 1.0f);
    EXPECT_NEAR(field[kFieldPrecision].at(x, 20) + field[kFieldPrecision + 2].at(x, 20), 1.0, 1e-4)
        << x;
  }
}

TEST(ShadowTracer, BorrowedBlockersMoveWithTheNearestBlockedSample) {
  World world;
  world.move();
  const int x = 24, y = 16;
  world.block(x + 2, y, 0.2f, 0.2f, 0.5);
  for (const int away : {-3, 3}) {  // farther ones, of a static blocker
    world.block(x + away, y + away, 0.2f, 0.2f, 0.5);
    world.id.ids().at(x + away, y + away) = 77;
  }
  const auto pixel = world.tracer().follow_borrowed(x, y, 0.5f);
  ASSERT_TRUE(pixel.in_front);
  const glm::dvec3 s = world.surface(x, y), centre(world.light_now[3]);
  const glm::dvec2 expected = world.expected(x, y, s + 0.5 * (centre - s), 0.5f, 0.5f);
  EXPECT_NEAR(pixel.x, expected.x, 2e-3);
  EXPECT_NEAR(pixel.y, expected.y, 2e-3);
}

TEST(ShadowTracer, IsAtRestOnlyWhereCameraLightReceiverAndBlockerAre) {
  const auto at_rest = [](void (*disturb)(World&)) {
    World world;
    world.camera_before = world.camera;
    world.light_before = world.light_now;
    world.blocker_before = world.blocker_now;
    world.floor_before = world.floor_now;
    disturb(world);
    world.move();
    return world.tracer().at_rest(world.scene.slot_of(1), world.scene.slot_of(2));
  };
  EXPECT_TRUE(at_rest([](World&) {}));
  EXPECT_FALSE(at_rest([](World& w) { w.camera_before = World().camera_before; }));
  EXPECT_FALSE(at_rest([](World& w) { w.light_before = World().light_before; }));
  EXPECT_FALSE(at_rest([](World& w) { w.blocker_before = World().blocker_before; }));
  EXPECT_FALSE(at_rest([](World& w) { w.floor_before = World().floor_before; }));
}

TEST(ShadowTracer, ABlockerWithoutAPastMayHaveComeFromAnywhere) {
  World world;
  world.move();
  world.blocker_before = glm::dmat4(0);  // no inverse: nobody knows where it was
  world.move();
  const int x = 16, y = 16;
  const BlockPixels pixels(world.guides, x, y, 8);
  std::vector<float> ratio(kFollowBlock, 0.5f);
  FollowedBlock out{};
  const int slot = world.scene.slot_of(2);
  ASSERT_FALSE(world.scene.object(slot).traceable);
  world.tracer().follow_block(pixels, x, y, ratio.data(), nullptr, 0, slot, out);
  for (int i = 0; i < 8; ++i) {
    EXPECT_EQ(out.found[i], 0.0f);
    EXPECT_EQ(out.sweep[i], kUnknownSweep);
  }
}

TEST(ShadowTracer, MeasuresNothingWithoutSurfaceBlockerOrLightAbove) {
  World world;
  world.light_now = glm::translate(glm::dmat4(1), {0, kFloorY - 2, -1});
  world.move();
  world.block(20, 16, 0.5f, 0.5f, 0.5);  // the light is under the floor
  test::set_pixel(world.guides, 21, 16, 0.0f, glm::vec3(0));
  world.distance.channel(0).at(21, 16) = 1.0f;  // sky
  world.distance.channel(0).at(22, 16) = test::kNaN;
  world.distance.channel(0).at(23, 16) = -1.0f;
  Channels<float> field(kWidth, kHeight, kEffectFieldChannels);
  world.tracer().measure(field, 0);
  for (int c = 0; c < kEffectFieldChannels; ++c)
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) ASSERT_EQ(field[c].at(x, y), 0.0f) << x << " " << y;
}

// The blocker at height h under a light at height H casts the light's half width w/2 as w/2 h/(H-h)
// on the floor; the footprint is half the inverse of 1/6 of its square plus half a pixel squared.
TEST(ShadowTracer, FootprintIsThePenumbraInPixels) {
  World world;
  world.camera = test::orthographic_camera(kWidth, kHeight, {0, 5, 0}, {1e-9, -1, 0});
  world.camera.view_from_world =
      glm::lookAt(glm::dvec3(0, 5, 0), glm::dvec3(0), glm::dvec3(0, 0, -1));
  world.light.width = 1.5;
  world.light.height = 0.5;
  const int x = 24, y = 16;
  // Local X stays world X, local Y becomes world -Z; straight above the pixel.
  const double px = 4.0 / kHeight;  // metres
  world.light_now = glm::rotate(glm::translate(glm::dmat4(1), {0.5 * px, kFloorY + 4, 0.5 * px}),
                                1.57079632679489662, glm::dvec3(1, 0, 0));
  world.move();
  world.block(x, y, 0.5f, 0.5f, 0.5);
  Channels<float> field(kWidth, kHeight, kEffectFieldChannels);
  world.tracer().measure(field, 0);
  const double across = 0.75 / px, along = 0.25 / px;
  EXPECT_NEAR(field[kFieldPrecision].at(x, y), 0.5 / (across * across / 6 + 0.5), 1e-4);
  EXPECT_NEAR(field[kFieldPrecision + 1].at(x, y), 0.0, 1e-4);
  EXPECT_NEAR(field[kFieldPrecision + 2].at(x, y), 0.5 / (along * along / 6 + 0.5), 1e-4);
}

// A blocker close to the light casts it over more than the picture, and past the camera: by the
// derivative, 1e4 times the size is 1e8 times the covariance.
TEST(ShadowTracer, FootprintGrowsWithTheLightPastTheCamera) {
  float precision[2];
  for (const double scale : {1e-2, 1.0}) {
    World world;
    world.light.width *= scale;
    world.light.height *= scale;
    world.move();
    world.block(20, 16, 0.5f, 0.5f, 0.9);
    Channels<float> field(kWidth, kHeight, kEffectFieldChannels);
    world.tracer().measure(field, 0);
    const double e = field[kFieldPrecision].at(20, 16), f = field[kFieldPrecision + 1].at(20, 16),
                 g = field[kFieldPrecision + 2].at(20, 16);
    precision[scale < 1] = static_cast<float>(g / (2 * (e * g - f * f)) - 0.5);
  }
  EXPECT_GT(precision[0], 400.0f) << "px^2: wider than 20 pixels";
  EXPECT_NEAR(precision[1] * 1e4f / precision[0], 1.0f, 0.02f);
}

// A light that moves by a whole width of its own, before a blocker that stands still.
TEST(ShadowSweep, IsOneWhereTheLightMovesByItsWidth) {
  const glm::dvec3 surface(0.2, 0, -1), light(1, 3, -2), before = light + glm::dvec3(0.6, 0, 0);
  const glm::dmat3 half_axes{{0.3, 0, 0}, {0, 0, 0.2}, {0, 0, 0}};
  for (const double ratio : {0.2, 0.9}) {
    const glm::dvec3 blocker = surface + ratio * (light - surface);
    const auto sweep = [&](const glm::dvec3& s, const glm::dvec3& b, const glm::dvec3& l) {
      return shadow_sweep(ShadowSample<double>{s, {0, 1, 0}, b, glm::dvec4(l, 1)}, ratio,
                          half_axes);
    };
    EXPECT_NEAR(sweep(surface, blocker, before), 1.0, 1e-12);
    EXPECT_NEAR(sweep(surface, blocker, light), 0.0, 1e-12) << "nothing moves";
    const glm::dvec3 all(0.5, -0.1, 0.3);
    EXPECT_NEAR(sweep(surface + all, blocker + all, light + all), 0.0, 1e-12) << "all move as one";
    EXPECT_NEAR(sweep(surface, blocker + glm::dvec3(0.6 * ratio, 0, 0), light), 1.0, 1e-12)
        << "a blocker's motion is seen magnified";
  }
}

}  // namespace
}  // namespace holdfast
