// Determinism, tables of motion, and references that are kept.

#include <cstring>

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include "core/frame/error.h"
#include "tests/scenes/small_scenes.h"

namespace holdfast::scenes {
namespace {

bool same_bytes(const PlaneSet& a, const PlaneSet& b) {
  if (a.size() != b.size()) return false;
  for (const Plane& plane : a) {
    const Plane* other = b.find(plane.id());
    if (!other) return false;
    for (int c = 0; c < plane.channels(); ++c)
      for (int y = 0; y < plane.height(); ++y)
        if (std::memcmp(plane.words(c).row(y), other->words(c).row(y),
                        4 * static_cast<std::size_t>(plane.width())) != 0)
          return false;
  }
  return true;
}

RenderSettings quick_settings() {
  RenderSettings settings = small_settings(48, 27);
  settings.reference_spp = 32;
  return settings;
}

TEST(Renderer, GivesTheSameBytesForOneAndTwoThreads) {
  for (const char* name : {"fence", "static"}) {
    Frame frames[2];
    PlaneSet references[2];
    for (int threads = 1; threads <= 2; ++threads) {
      tbb::task_arena(threads).execute([&] {
        Renderer renderer(builtin_scene(name), quick_settings());
        const StillView still(builtin_scene(name), 48, 27);
        frames[threads - 1] = renderer.frame(5);
        references[threads - 1] = render_reference(still.view, 32);
      });
    }
    EXPECT_TRUE(same_bytes(frames[0].planes, frames[1].planes)) << name;
    EXPECT_TRUE(same_bytes(references[0], references[1])) << name;
  }
}

TEST(Renderer, FrameDoesNotDependOnWhatWasRenderedBefore) {
  Renderer a(fence_scene(), quick_settings()), b(fence_scene(), quick_settings());
  a.frame(0);
  a.reference(3);
  EXPECT_TRUE(same_bytes(a.frame(4).planes, b.frame(4).planes));
}

TEST(Renderer, NoiseDiffersBetweenFramesAndSeeds) {
  RenderSettings settings = quick_settings();
  Renderer a(static_scene(), settings);
  settings.seed = 2;
  Renderer b(static_scene(), settings);
  const PlaneSet zero = a.frame(0).planes;
  EXPECT_FALSE(same_bytes(zero, a.frame(1).planes));
  EXPECT_FALSE(same_bytes(zero, b.frame(0).planes));
}

TEST(Renderer, FirstFrameNamesAllTransformsAndLaterOnesWhatMoves) {
  RenderSettings settings = quick_settings();
  settings.first_frame = 2;
  Renderer renderer(fence_scene(), settings);
  const Frame first = renderer.frame(2), next = renderer.frame(3);
  EXPECT_EQ(first.objects.size(), 4u);
  EXPECT_EQ(first.lights.size(), 1u);
  EXPECT_TRUE(next.objects.empty());
  ASSERT_EQ(next.lights.size(), 1u);
  EXPECT_NE(next.lights.at(0), first.lights.at(0));
  Renderer still(static_scene(), quick_settings());
  EXPECT_TRUE(still.frame(1).lights.empty());
}

TEST(Renderer, ObjectAppearsWithItsTransformInItsFirstFrame) {
  Scene scene = floor_and_box(rectangle_light(), {0.8, 2.2, -1.0});
  scene.objects[1].from_frame = 2.0;
  Renderer renderer(scene, small_settings());
  const auto shows_box = [](const Frame& frame) {
    const auto ids = frame.planes.at({PlaneKind::kObjectId, {}}).ids();
    for (int y = 0; y < ids.height; ++y)
      for (int x = 0; x < ids.width; ++x)
        if (ids.at(x, y) == 9) return true;
    return false;
  };
  const Frame before = renderer.frame(1), after = renderer.frame(2);
  EXPECT_FALSE(shows_box(before));
  EXPECT_TRUE(shows_box(after));
  EXPECT_EQ(after.objects.count(9), 1u);
}

TEST(Renderer, MovedObjectIsWhereItsMatrixPutsIt) {
  Scene scene = floor_and_box(rectangle_light(), {0.8, 2.2, -1.0});
  Key start, end{10.0, Transform{}, false};
  end.transform.translation = {2.0, 0.0, 0.0};
  scene.objects[1].motion.keys = {start, end};
  Renderer renderer(scene, small_settings());
  const Frame frame = renderer.frame(5);
  EXPECT_EQ(frame.objects.at(9)[3], glm::dvec4(1.0, 0.0, 0.0, 1.0));
  const glm::dvec4 clip = frame.camera.clip_from_view * frame.camera.view_from_world *
                          (frame.objects.at(9) * glm::dvec4(0.0, 0.7, 0.2, 1.0));  // on its top
  const auto x = static_cast<int>((clip.x / clip.w * 0.5 + 0.5) * 40);
  const auto y = static_cast<int>((0.5 - clip.y / clip.w * 0.5) * 30);
  EXPECT_EQ(frame.planes.at({PlaneKind::kObjectId, {}}).ids().at(x, y), 9u);
}

TEST(Renderer, CameraJumpIsACut) {
  Scene scene = floor_and_box(rectangle_light(), {0.8, 2.2, -1.0});
  scene.camera.motion.keys.push_back({4.0, look_at({2.0, 3.0, 4.0}, {0.0, 0.0, 0.0}), true});
  Renderer renderer(scene, small_settings(8, 6));
  EXPECT_FALSE(renderer.frame(3).cut);
  EXPECT_TRUE(renderer.frame(4).cut);
  EXPECT_FALSE(renderer.frame(5).cut);
  EXPECT_EQ(renderer.frame(3).camera.view_from_world, renderer.frame(0).camera.view_from_world);
}

TEST(Renderer, SpeedScalesTime) {
  RenderSettings settings = quick_settings();
  Renderer slow(fence_scene(), settings);
  settings.speed = 4.0;
  Renderer fast(fence_scene(), settings);
  EXPECT_EQ(fast.frame(2).lights.at(0), slow.frame(8).lights.at(0));
}

TEST(Renderer, RefusesSettingsOutOfRange) {
  RenderSettings settings = quick_settings();
  settings.width = 0;
  EXPECT_THROW(Renderer(fence_scene(), settings), InputError);
  settings = quick_settings();
  settings.spp = 0;
  EXPECT_THROW(Renderer(fence_scene(), settings), InputError);
}

TEST(BuiltinScenes, UnknownNameListsTheNames) {
  try {
    builtin_scene("fense");
    FAIL();
  } catch (const InputError& error) {
    const std::string message = error.what();
    for (const BuiltinScene& scene : builtin_scenes())
      EXPECT_NE(message.find(scene.name), std::string::npos) << message;
    EXPECT_NE(message.find("fense"), std::string::npos) << message;
  }
}

TEST(BuiltinScenes, CutSceneCutsSwitchesALightOnAndAddsAnObject) {
  Renderer renderer(cut_scene(), small_settings(32, 18));
  EXPECT_TRUE(renderer.frame(30).cut);
  EXPECT_FALSE(renderer.frame(29).cut);
  const auto light_of = [&](std::int64_t index) {
    const Frame frame = renderer.frame(index);
    const auto red = frame.planes.at(of_light(PlaneKind::kUnshadowed, 1)).channel(0);
    float sum = 0.0f;
    for (int y = 0; y < red.height; ++y)
      for (int x = 0; x < red.width; ++x) sum += red.at(x, y);
    return sum;
  };
  EXPECT_EQ(light_of(59), 0.0f);
  EXPECT_GT(light_of(60), 1.0f);
  EXPECT_EQ(renderer.frame(0).lights.count(1), 1u) << "there, but dark";
  EXPECT_TRUE(renderer.frame(60).lights.empty()) << "nothing has moved";
  EXPECT_EQ(renderer.frame(90).objects.count(7), 1u);
}

TEST(BuiltinScenes, ShadowsMoveInEveryFrameAtBothSpeeds) {
  for (const char* name : {"fence", "cylinder"}) {
    const Scene scene = builtin_scene(name);
    for (const double speed : {1.0, 4.0})
      for (int i = 0; i < 32; ++i)
        EXPECT_NE(scene.lights[0].motion.at(i * speed), scene.lights[0].motion.at((i + 1) * speed));
  }
}

}  // namespace
}  // namespace holdfast::scenes
