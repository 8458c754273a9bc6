#include <cmath>
#include <numbers>

#include "client/scenes/builtin.h"

namespace holdfast::scenes {
namespace {

/// The light swings about the fence, to and fro, on a circle behind it.
Motion swinging_arc() {
  constexpr double kPeriodFrames = 240.0;
  constexpr int kKeys = 60;
  constexpr double kSwingRad = 0.75, kRadius_m = 4.2, kHeight_m = 3.6;
  Motion motion;
  motion.keys.clear();
  motion.repeat = Repeat::kLoop;
  for (int i = 0; i <= kKeys; ++i) {
    const double phi = -kSwingRad * std::cos(2.0 * std::numbers::pi * (i + 6.0) / kKeys);
    const glm::dvec3 eye(kRadius_m * std::sin(phi), kHeight_m, -kRadius_m * std::cos(phi));
    motion.keys.push_back({kPeriodFrames * i / kKeys, look_at(eye, {0.0, 0.3, 0.8}), false});
  }
  return motion;
}

std::vector<Part> stones() {
  return {box_part({0.55, 0.16, 0.40}, {-1.25, 0.08, 1.25}, 25.0),
          box_part({0.40, 0.30, 0.40}, {-0.15, 0.15, 1.75}, -20.0),
          box_part({0.90, 0.10, 0.50}, {1.15, 0.05, 1.20}, 10.0),
          box_part({0.30, 0.22, 0.55}, {2.05, 0.11, 1.85}, 50.0),
          box_part({0.35, 0.12, 0.35}, {-2.15, 0.06, 2.00}, 70.0)};
}

}  // namespace

Scene fence_scene() {
  Scene scene;
  scene.name = "fence";
  scene.components = {true, false, false};
  scene.sky = {{0.62, 0.66, 0.74}, {0.28, 0.38, 0.58}};
  scene.ambient = {0.19, 0.22, 0.29};
  scene.camera.vertical_fov_deg = 36.0;
  scene.camera.motion = Motion(look_at({0.8, 2.2, 4.8}, {0.02, 0.26, 0.9}));

  const Material tiles{.albedo = {0.62, 0.55, 0.44}, .checker = Checker{{0.52, 0.45, 0.36}, 0.5}};
  scene.objects = {
      still_object(1, "ground", tiles, {quad_part(40.0, 40.0)}),
      still_object(2, "fence", {.albedo = {0.72, 0.36, 0.20}}, fence_parts(11, 0.36, 1.05)),
      still_object(3, "stones", {.albedo = {0.45, 0.50, 0.52}}, stones()),
      still_object(4, "ball", {.albedo = {0.20, 0.48, 0.52}},
                   {sphere_part(0.28, {0.62, 0.28, 2.25})})};

  SceneLight light;
  light.light = {.id = 0, .shape = LightShape::kRectangle, .width = 0.55, .height = 0.35};
  light.emission = glm::dvec3(760.0, 690.0, 560.0);
  light.motion = swinging_arc();
  scene.lights = {light};
  return scene;
}

}  // namespace holdfast::scenes
