#include "client/scenes/builtin.h"

namespace holdfast::scenes {

Scene cylinder_scene() {
  Scene scene;
  scene.name = "cylinder";
  scene.components = {true, false, false};
  scene.sky = {{0.55, 0.60, 0.70}, {0.25, 0.34, 0.55}};
  scene.ambient = {0.09, 0.11, 0.16};
  scene.camera.vertical_fov_deg = 34.0;
  scene.camera.motion = Motion(look_at({0.0, 2.6, 5.8}, {0.0, 0.45, 0.7}));

  Part plane;
  plane.shape = PartShape::kQuad;
  plane.size_m = {40.0, 0.0, 40.0};
  const Material floor{.albedo = {0.58, 0.60, 0.56}, .checker = Checker{{0.48, 0.51, 0.48}, 0.6}};
  scene.objects = {still_object(1, "plane", floor, {plane}),
                   still_object(2, "cylinder", {.albedo = {0.75, 0.30, 0.16}},
                                {cylinder_part(0.42, 1.7, {0.0, 0.85, 0.0})})};

  SceneLight light;
  light.light = {.id = 0, .shape = LightShape::kRectangle, .width = 0.8, .height = 0.8};
  light.emission = glm::dvec3(105.0, 98.0, 84.0);
  const glm::dvec3 target(0.0, 0.2, 0.5);
  light.motion.keys.clear();
  light.motion.repeat = Repeat::kMirror;
  for (int i = 0; i <= 16; ++i)  // to the left, 4 cm a frame
    light.motion.keys.push_back(
        {10.0 * i, look_at({3.2 - 0.4 * i, 3.4, -3.0}, target), false});
  scene.lights = {light};
  return scene;
}

}  // namespace holdfast::scenes
