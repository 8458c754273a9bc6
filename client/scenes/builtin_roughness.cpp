#include "client/scenes/builtin.h"

namespace holdfast::scenes {
namespace {

/// Turns by `degrees` about `axis` on its way along a line, and back again, for ever.
Motion tumbling(const glm::dvec3& from, const glm::dvec3& to, const glm::dvec3& axis,
                double degrees, double frames) {
  Motion motion = to_and_fro(from, to, frames);
  motion.keys.back().transform.rotation = glm::angleAxis(glm::radians(degrees), axis);
  return motion;
}

}  // namespace

Scene roughness_scene(double roughness, bool camera_moves) {
  Scene scene;
  scene.name = "roughness";
  scene.components = {false, true, false};
  scene.sky = {{0.55, 0.58, 0.64}, {0.24, 0.34, 0.56}};
  scene.camera.vertical_fov_deg = 38.0;
  scene.camera.motion = Motion(look_at({0.0, 1.7, 4.6}, {0.0, 0.35, 0.0}));
  if (camera_moves)
    scene.camera.motion.keys.push_back({20.0, look_at({0.9, 1.5, 4.2}, {0.1, 0.35, 0.0}), false});

  const Material floor{
      .albedo = glm::dvec3(0.1), .roughness = roughness, .specular = glm::dvec3(0.55)};
  scene.objects = {still_object(1, "floor", floor, {quad_part(16.0, 16.0)})};
  const Material tiles{.albedo = {0.60, 0.55, 0.46}, .checker = Checker{{0.25, 0.28, 0.34}, 0.6}};
  scene.objects.push_back(
      still_object(2, "wall", tiles, {box_part({9.0, 2.2, 0.2}, {0.0, 1.1, -2.6})}));
  const Material red{.albedo = {0.80, 0.16, 0.08}, .checker = Checker{{0.85, 0.70, 0.20}, 0.25}};
  scene.objects.push_back(
      still_object(3, "sliding block", red, {box_part({0.5, 0.9, 0.5}, glm::dvec3(0.0), 30.0)}));
  scene.objects.back().motion = to_and_fro({-1.6, 0.46, -0.9}, {1.6, 0.46, -0.9}, 40.0);
  const Material teal{.albedo = {0.10, 0.55, 0.52}, .emission = {0.02, 0.15, 0.14}};
  scene.objects.push_back(
      still_object(4, "hovering ball", teal, {sphere_part(0.3, glm::dvec3(0.0))}));
  scene.objects.back().motion = to_and_fro({1.6, 1.1, 0.3}, {-1.4, 0.4, 0.9}, 40.0);
  const Material bright{.albedo = {0.75, 0.72, 0.20}, .emission = {0.30, 0.28, 0.06}};
  scene.objects.push_back(
      still_object(5, "tumbling bar", bright, {box_part({1.1, 0.16, 0.16}, glm::dvec3(0.0))}));
  scene.objects.back().motion =
      tumbling({-1.5, 0.9, 0.5}, {-0.3, 1.1, -0.3}, {0.0, 0.6, 0.8}, 170.0, 40.0);

  // Points cast no noise: what is left of it in references comes from the lobe.
  SceneLight lamp;
  lamp.light = {.id = 0, .shape = LightShape::kPoint};
  lamp.emission = {38.0, 35.0, 30.0};
  lamp.motion = Motion(Transform{.translation = {1.4, 3.6, 2.4}});
  scene.lights = {lamp};
  return scene;
}

}  // namespace holdfast::scenes
