#include <cmath>

#include "client/scenes/builtin.h"

namespace holdfast::scenes {
namespace {

std::vector<Object> room_objects() {
  const Material plaster{.albedo = {0.72, 0.69, 0.64}};
  const Material parquet{.albedo = {0.42, 0.26, 0.14},
                         .checker = Checker{{0.50, 0.33, 0.19}, 0.4},
                         .roughness = 0.25,
                         .specular = glm::dvec3(0.06)};
  const Material steel{
      .albedo = glm::dvec3(0.02), .roughness = 0.2, .specular = {0.62, 0.60, 0.58}};
  const Material lacquer{
      .albedo = {0.65, 0.10, 0.06}, .roughness = 0.3, .specular = glm::dvec3(0.05)};
  std::vector<Part> shell{box_part({6.0, 0.1, 6.0}, {0.0, 2.85, 0.0}),
                          box_part({6.0, 2.8, 0.1}, {0.0, 1.4, -3.0})};
  return {
      still_object(1, "floor", parquet, {quad_part(6.0, 6.0)}),
      still_object(2, "shell", plaster, std::move(shell)),
      still_object(3, "blue wall", {.albedo = {0.12, 0.22, 0.60}},
                   {box_part({0.1, 2.8, 6.0}, {-3.0, 1.4, 0.0})}),
      still_object(4, "ochre wall", {.albedo = {0.75, 0.50, 0.12}},
                   {box_part({0.1, 2.8, 6.0}, {3.0, 1.4, 0.0})}),
      still_object(5, "screen", {.albedo = {0.70, 0.42, 0.25}}, fence_parts(7, 0.30, 1.0)),
      still_object(6, "steel ball", steel, {sphere_part(0.4, {1.1, 0.4, 0.9})}),
      still_object(7, "red block", lacquer, {box_part({0.5, 0.7, 0.5}, glm::dvec3(0.0), 25.0)})};
}

/// A panel that lies flat under the ceiling: no surface comes near its bright side.
Transform below_ceiling(double x) { return look_at({x, 2.79, -1.6}, {x, 0.0, -1.6}); }

SceneLight ceiling_panel() {
  SceneLight panel;
  panel.light = {.id = 0, .shape = LightShape::kRectangle, .width = 0.8, .height = 0.5};
  panel.emission = {58.0, 54.0, 46.0};
  return panel;
}

}  // namespace

Scene room_scene() {
  Scene scene;
  scene.name = "room";
  scene.camera.vertical_fov_deg = 46.0;
  scene.camera.motion.keys = {{0.0, look_at({-1.0, 1.5, 4.4}, {0.1, 0.7, 0.0}), false},
                              {80.0, look_at({1.0, 1.6, 4.1}, {0.0, 0.7, 0.0}), false}};
  scene.camera.motion.repeat = Repeat::kMirror;
  scene.objects = room_objects();
  scene.objects.back().motion = to_and_fro({-1.8, 0.36, 1.1}, {0.4, 0.36, 1.6}, 70.0);
  scene.lights = {ceiling_panel()};
  scene.lights[0].motion.keys = {{0.0, below_ceiling(-1.4), false},
                                 {70.0, below_ceiling(1.4), false}};
  scene.lights[0].motion.repeat = Repeat::kMirror;
  return scene;
}

Scene cut_scene() {
  Scene scene = room_scene();
  scene.name = "cut";
  scene.camera.motion = Motion(look_at({-1.0, 1.5, 4.4}, {0.1, 0.7, 0.0}));
  scene.camera.motion.keys.push_back({30.0, look_at({2.2, 1.9, 3.2}, {-0.2, 0.5, 0.2}), true});
  scene.lights[0].motion = Motion(below_ceiling(-0.8));
  SceneLight lamp = rectangle_at({2.2, 2.1, 2.0}, {0.0, 0.2, 0.6}, 0.5, 0.5, {26.0, 34.0, 52.0});
  lamp.light.id = 1;
  lamp.from_frame = 60.0;
  scene.lights.push_back(lamp);
  scene.objects.back().motion = Motion(Transform{.translation = {-0.6, 0.36, 1.5}});
  scene.objects.back().from_frame = 90.0;
  return scene;
}

}  // namespace holdfast::scenes
