#include "client/scenes/builtin.h"

namespace holdfast::scenes {

Scene glossy_floor_scene() {
  Scene scene;
  scene.name = "glossy-floor";
  scene.components = {true, true, false};
  scene.sky = {{0.55, 0.58, 0.64}, {0.24, 0.34, 0.56}};
  scene.ambient = {0.20, 0.23, 0.30};
  scene.camera.vertical_fov_deg = 36.0;
  scene.camera.motion = Motion(look_at({0.0, 1.9, 5.2}, {0.0, 0.35, 0.4}));

  // Four lanes, from nearly a mirror on the left to rough on the right.
  const double roughness[] = {0.05, 0.15, 0.30, 0.50};
  for (std::uint32_t i = 0; i < 4; ++i) {
    const Material lane{.albedo = glm::dvec3(0.10, 0.10, 0.11) * (1.0 + 0.3 * (i % 2)),
                        .roughness = roughness[i],
                        .specular = glm::dvec3(0.55)};
    Part quad = quad_part(1.3, 9.0);
    quad.placement.translation = {1.3 * i - 1.95, 0.0, 0.0};
    scene.objects.push_back(still_object(1 + i, "lane " + std::to_string(i), lane, {quad}));
  }
  scene.objects.push_back(still_object(5, "wall", {.albedo = {0.62, 0.57, 0.48}},
                                       {box_part({9.0, 3.0, 0.2}, {0.0, 1.5, -2.6})}));
  const Material red{.albedo = {0.80, 0.16, 0.08}, .emission = {0.25, 0.04, 0.02}};
  const Material teal{.albedo = {0.10, 0.55, 0.52}, .emission = {0.02, 0.15, 0.14}};
  scene.objects.push_back(
      still_object(6, "red block", red, {box_part({0.45, 0.8, 0.45}, glm::dvec3(0.0), 30.0)}));
  scene.objects.back().motion = to_and_fro({-2.2, 0.45, -0.4}, {2.2, 0.45, -0.4}, 110.0);
  scene.objects.push_back(still_object(7, "teal ball", teal, {sphere_part(0.32, {0, 0, 0})}));
  scene.objects.back().motion = to_and_fro({2.0, 0.36, 0.9}, {-2.0, 0.36, 0.9}, 130.0);
  scene.lights = {rectangle_at({1.4, 3.6, 2.4}, {0.0, 0.2, -0.4}, 0.8, 0.8, {70.0, 65.0, 56.0})};
  return scene;
}

}  // namespace holdfast::scenes
