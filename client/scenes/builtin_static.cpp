#include "client/scenes/builtin.h"

namespace holdfast::scenes {

Scene static_scene() {
  Scene scene;
  scene.name = "static";
  scene.sky = {{0.50, 0.54, 0.60}, {0.26, 0.36, 0.56}};
  scene.camera.vertical_fov_deg = 36.0;
  scene.camera.motion = Motion(look_at({0.8, 2.15, 5.0}, {0.0, 0.33, 0.85}));

  const Material floor{.albedo = {0.50, 0.46, 0.40},
                       .checker = Checker{{0.36, 0.33, 0.30}, 0.5},
                       .roughness = 0.35,
                       .specular = glm::dvec3(0.05)};
  const Material paint{
      .albedo = {0.16, 0.34, 0.62}, .roughness = 0.3, .specular = glm::dvec3(0.04)};
  const Material copper{
      .albedo = glm::dvec3(0.02), .roughness = 0.25, .specular = {0.95, 0.64, 0.54}};
  scene.objects = {
      still_object(1, "ground", floor, {quad_part(40.0, 40.0)}),
      still_object(2, "fence", {.albedo = {0.72, 0.36, 0.20}}, fence_parts(11, 0.36, 1.05)),
      still_object(3, "red wall", {.albedo = {0.75, 0.12, 0.08}},
                   {box_part({0.12, 1.6, 3.0}, {-2.45, 0.8, 1.6})}),
      still_object(4, "blue block", paint, {box_part({0.6, 0.6, 0.6}, {-1.2, 0.3, 1.6}, 30.0)}),
      still_object(5, "copper ball", copper, {sphere_part(0.36, {0.75, 0.36, 2.0})})};

  SceneLight light;
  light.light = {.id = 0, .shape = LightShape::kRectangle, .width = 0.55, .height = 0.35};
  light.emission = glm::dvec3(520.0, 470.0, 380.0);
  light.motion = Motion(look_at({1.6, 3.6, -3.8}, {0.0, 0.3, 0.8}));
  scene.lights = {light};
  return scene;
}

}  // namespace holdfast::scenes
