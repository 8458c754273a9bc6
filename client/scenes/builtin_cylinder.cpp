#include "client/scenes/builtin.h"

namespace holdfast::scenes {

Scene cylinder_scene() {
  Scene scene;
  scene.name = "cylinder";
  scene.components = {true, false, false};
  scene.sky = {{0.55, 0.60, 0.70}, {0.25, 0.34, 0.55}};
  scene.ambient = {0.17, 0.20, 0.27};
  scene.camera.vertical_fov_deg = 34.0;
  scene.camera.motion = Motion(look_at({0.0, 2.3, 4.9}, {0.0, 0.42, 0.9}));

  const Material floor{.albedo = {0.58, 0.60, 0.56}, .checker = Checker{{0.48, 0.51, 0.48}, 0.6}};
  scene.objects = {still_object(1, "plane", floor, {quad_part(40.0, 40.0)}),
                   still_object(2, "cylinder", {.albedo = {0.75, 0.30, 0.16}},
                                {cylinder_part(0.5, 1.5, {0.0, 0.75, 0.0})})};

  SceneLight light;
  light.light = {.id = 0, .shape = LightShape::kRectangle, .width = 1.3, .height = 1.3};
  light.emission = glm::dvec3(54.0, 50.0, 41.0);
  const glm::dvec3 target(0.0, 0.2, 0.5);
  light.motion.keys.clear();
  light.motion.repeat = Repeat::kMirror;
  for (int i = 0; i <= 13; ++i)  // to the left, 4 cm a frame
    light.motion.keys.push_back({10.0 * i, look_at({2.6 - 0.4 * i, 3.3, -2.8}, target), false});
  scene.lights = {light};
  return scene;
}

}  // namespace holdfast::scenes
