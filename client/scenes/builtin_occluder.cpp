#include "client/scenes/builtin.h"

namespace holdfast::scenes {

Scene occluder_scene() {
  Scene scene;
  scene.name = "occluder";
  scene.components = {true, false, true};
  scene.camera.vertical_fov_deg = 38.0;
  scene.camera.motion = Motion(look_at({0.0, 1.2, 4.6}, {0.0, 1.0, 0.0}));
  scene.objects = {still_object(1, "floor", {.albedo = {0.55, 0.53, 0.50}}, {quad_part(5.0, 7.0)}),
                   still_object(2, "wall", {.albedo = glm::dvec3(0.75)},
                                {box_part({5.0, 3.0, 0.2}, {0.0, 1.5, -1.6})}),
                   still_object(3, "red side", {.albedo = {0.85, 0.08, 0.05}},
                                {box_part({0.2, 3.0, 5.0}, {-2.3, 1.5, 0.9})}),
                   still_object(4, "green side", {.albedo = {0.08, 0.75, 0.12}},
                                {box_part({0.2, 3.0, 5.0}, {2.3, 1.5, 0.9})}),
                   still_object(5, "post", {.albedo = {0.75, 0.60, 0.30}},
                                {box_part({0.42, 1.9, 0.3}, glm::dvec3(0.0), 20.0)})};
  scene.objects.back().motion = to_and_fro({-1.6, 0.95, 0.9}, {1.6, 0.95, 0.9}, 60.0);
  // Two lights face the side walls from near the camera: the wall is lit by what they reflect.
  scene.lights = {rectangle_at({0.3, 2.3, 1.2}, {-2.3, 1.2, 0.6}, 0.7, 0.5, {60.0, 58.0, 54.0}),
                  rectangle_at({-0.3, 2.3, 1.2}, {2.3, 1.2, 0.6}, 0.7, 0.5, {60.0, 58.0, 54.0})};
  scene.lights[1].light.id = 1;
  return scene;
}

}  // namespace holdfast::scenes
