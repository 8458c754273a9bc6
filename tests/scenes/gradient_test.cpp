// Gradient samples: the same sample shaded in two frames.

#include <gtest/gtest.h>

#include "client/scenes/gradient_frame.h"
#include "core/frame/plane_size.h"
#include "tests/scenes/small_scenes.h"

namespace holdfast::scenes {
namespace {

constexpr Component kLight3{ComponentKind::kVisibility, 3};
constexpr Component kGlossy{ComponentKind::kGlossy, 0};
constexpr Component kIndirect{ComponentKind::kIndirect, 0};

const Plane& gradient(const PlaneSet& planes, Component component) {
  return planes.at({PlaneKind::kGradient, component});
}

/// How many samples of a plane differ between now and then, and how many there are.
struct Count {
  int changed = 0, samples = 0;
};
Count count(const Plane& plane) {
  Count out;
  for (int y = 0; y < plane.height(); ++y)
    for (int x = 0; x < plane.width(); ++x) {
      const float now = plane.channel(0).at(x, y), then = plane.channel(1).at(x, y);
      out.samples += now > 0.0f || then > 0.0f;
      out.changed += now != then;
    }
  return out;
}

/// A glossy floor below the sky and a box over it; box and light move along X, metres a frame.
Scene moving_scene(double box_speed, double light_speed) {
  Scene scene =
      floor_and_box(rectangle_light(), {0.8, 2.2, -1.0},
                    {.albedo = glm::dvec3(0.6), .roughness = 0.3, .specular = glm::dvec3(0.2)});
  scene.sky = {glm::dvec3(0.5), glm::dvec3(0.8)};
  const auto slide = [](Motion& motion, double speed) {
    Key end = motion.keys.front();
    end.frame = 100.0;
    end.transform.translation.x += 100.0 * speed;
    if (speed != 0.0) motion.keys.push_back(end);
  };
  slide(scene.objects[1].motion, box_speed);
  slide(scene.lights[0].motion, light_speed);
  return scene;
}

TEST(GradientSamples, OfAStillSceneAreTheSameNowAndThen) {
  const StillView still(moving_scene(0.0, 0.0));
  GradientSamples samples(still.view);
  PlaneSet planes = render_noisy(still.view, 1, &samples);
  samples.finish(still.view, 0.0, 0.0, planes);
  for (const Component component : {kLight3, kGlossy, kIndirect}) {
    const Count found = count(gradient(planes, component));
    EXPECT_EQ(found.changed, 0) << component_name(component);
    EXPECT_GT(found.samples, 50) << component_name(component);
  }
}

TEST(GradientSamples, NowAreTheFirstSamplesOfTheNoisyFrame) {
  Renderer renderer(moving_scene(0.1, 0.0), small_settings());
  const PlaneSet planes = renderer.frame(3).planes;
  const auto visibility = planes.at(of_light(PlaneKind::kVisibility)).channel(0);
  const auto now = gradient(planes, kLight3).channel(0);
  ASSERT_EQ(now.width, 14);
  ASSERT_EQ(now.height, 10);
  for (int y = 0; y < now.height; ++y)
    for (int x = 0; x < now.width; ++x) {
      bool is_one_of_nine = false;
      for (int k = 0; k < 9; ++k) {
        const int px = kStratum * x + k % 3, py = kStratum * y + k / 3;
        if (px < 40 && py < 30) is_one_of_nine |= now.at(x, y) == visibility.at(px, py);
      }
      EXPECT_TRUE(is_one_of_nine || now.at(x, y) == 0.0f) << x << ", " << y;
    }
}

TEST(GradientSamples, DifferOnlyWhereTheLightOfAMovingLampChanges) {
  RenderSettings settings = small_settings(90, 60);
  settings.reference_spp = 196;
  Renderer renderer(moving_scene(0.0, 0.5), settings);
  const PlaneSet planes = renderer.frame(2).planes;
  const Plane& visibility = gradient(planes, kLight3);
  const Count found = count(visibility);
  EXPECT_GT(found.changed, 5);
  EXPECT_LT(found.changed, found.samples / 4) << "only about the edges of the shadow";
  // Where either frame is far from the shadow, nothing changes.
  Renderer other(moving_scene(0.0, 0.5), settings);
  const PlaneSet &before = renderer.reference(1), &after = other.reference(2);
  const PlaneId id = of_light(PlaneKind::kVisibility);
  for (int y = 0; y < visibility.height(); ++y)
    for (int x = 0; x < visibility.width(); ++x) {
      bool is_lit = true;
      for (int k = 0; k < 9; ++k) {
        const int px = kStratum * x + k % 3, py = kStratum * y + k / 3;
        is_lit = is_lit && before.at(id).channel(0).at(px, py) == 1.0f &&
                 after.at(id).channel(0).at(px, py) == 1.0f;
      }
      if (!is_lit) continue;
      EXPECT_EQ(visibility.channel(0).at(x, y), visibility.channel(1).at(x, y)) << x << ", " << y;
    }
}

TEST(GradientSamples, FollowTheSurfaceOfAMovingObject) {
  // Floor and box move together under a directional light: seen from the surface nothing changes.
  Scene scene = floor_and_box({.id = 3, .shape = LightShape::kDirectional}, {0.8, 2.2, -1.0});
  Key end;
  end.frame = 1.0;
  end.transform.translation = {0.0, 0.0, 0.8};
  for (Object& object : scene.objects) object.motion.keys.push_back(end);
  Renderer renderer(scene, small_settings(60, 45));
  const Count found = count(gradient(renderer.frame(1).planes, kLight3));
  EXPECT_GT(found.samples, 100);
  EXPECT_LE(found.changed, 2) << "but for rays that graze an edge";
}

TEST(GradientSamples, AreNoneInTheFirstFrameAtACutAndInAStillFrame) {
  Scene scene = moving_scene(0.1, 0.0);
  scene.camera.motion.keys.push_back({4.0, look_at({2.0, 3.0, 4.0}, {0.0, 0.0, 0.0}), true});
  Renderer renderer(scene, small_settings());
  EXPECT_EQ(count(gradient(renderer.frame(0).planes, kLight3)).samples, 0);
  EXPECT_GT(count(gradient(renderer.frame(3).planes, kLight3)).samples, 50);
  EXPECT_EQ(count(gradient(renderer.frame(4).planes, kLight3)).samples, 0);
  Renderer still(moving_scene(0.0, 0.0), small_settings());
  EXPECT_EQ(count(gradient(still.frame(5).planes, kIndirect)).samples, 0);
}

TEST(GradientSamples, AreNoneOnAnObjectThatHasJustAppeared) {
  Scene scene = moving_scene(0.0, 0.1);
  scene.objects[1].from_frame = 2.0;
  Renderer renderer(scene, small_settings(90, 66));
  const PlaneSet planes = renderer.frame(2).planes;
  const auto ids = planes.at({PlaneKind::kObjectId, {}}).ids();
  const Plane& visibility = gradient(planes, kLight3);
  int strata_on_box = 0;
  for (int y = 0; y < visibility.height(); ++y)
    for (int x = 0; x < visibility.width(); ++x) {
      bool is_box = true;
      for (int k = 0; k < 9; ++k)
        is_box = is_box && ids.at(kStratum * x + k % 3, kStratum * y + k / 3) == 9u;
      if (!is_box) continue;
      ++strata_on_box;
      for (int c = 0; c < 2; ++c) EXPECT_EQ(visibility.channel(c).at(x, y), 0.0f);
    }
  EXPECT_GT(strata_on_box, 5);
}

TEST(GradientSamples, ChangeNothingElseInTheFrame) {
  RenderSettings settings = small_settings();
  Renderer with(moving_scene(0.1, 0.1), settings);
  settings.gradients = false;
  Renderer without(moving_scene(0.1, 0.1), settings);
  with.frame(3);
  const PlaneSet a = with.frame(7).planes, b = without.frame(7).planes;
  EXPECT_EQ(a.size(), b.size() + 3);
  for (const Plane& plane : b)
    for (int c = 0; c < plane.channels(); ++c)
      for (int y = 0; y < plane.height(); ++y)
        for (int x = 0; x < plane.width(); ++x)
          ASSERT_EQ(plane.words(c).at(x, y), a.at(plane.id()).words(c).at(x, y))
              << plane_name(plane.id());
}

}  // namespace
}  // namespace holdfast::scenes
