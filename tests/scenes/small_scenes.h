#pragma once

#include "client/scenes/builtin.h"
#include "client/scenes/noisy_frame.h"
#include "client/scenes/reference_frame.h"
#include "client/scenes/renderer.h"
#include "client/scenes/view.h"

namespace holdfast::scenes {

/// A scene of a floor (id 7), a box (id 9) that floats above it, and one light; a camera looks
/// down.
inline Scene floor_and_box(const Light& light, const glm::dvec3& light_at,
                           const Material& floor = {.albedo = glm::dvec3(0.6)}) {
  Scene scene;
  scene.name = "floor and box";
  scene.camera.motion = Motion(look_at({0.0, 3.0, 4.0}, {0.0, 0.0, 0.0}));
  Part ground;
  ground.shape = PartShape::kQuad;
  ground.size_m = {8.0, 0.0, 8.0};
  scene.objects = {still_object(7, "floor", floor, {ground}),
                   still_object(9, "box", {.albedo = {0.7, 0.4, 0.2}},
                                {box_part({0.7, 0.4, 0.5}, {0, 0.5, 0})})};
  SceneLight out;
  out.light = light;
  out.emission = {9.0, 8.0, 6.0};
  out.motion = Motion(look_at(light_at, {0.0, 0.0, 0.0}));
  scene.lights = {out};
  return scene;
}

inline Light rectangle_light() {
  return {.id = 3, .shape = LightShape::kRectangle, .width = 1.2, .height = 0.8};
}

inline RenderSettings small_settings(int width = 40, int height = 30) {
  RenderSettings settings;
  settings.width = width;
  settings.height = height;
  return settings;
}

/// A view of a scene at time 0; holds the world.
struct StillView {
  explicit StillView(Scene s, int width = 40, int height = 30)
      : scene(std::move(s)), world(scene), view{scene,
                                                world,
                                                lights_at(scene, 0.0),
                                                camera_at(scene, 0.0, width, height),
                                                width,
                                                height,
                                                5,
                                                0} {}

  Scene scene;
  World world;
  View view;
};

inline PlaneId of_light(PlaneKind kind, std::uint32_t light = 3) {
  return PlaneId::of_light(kind, light);
}

inline glm::dvec3 colour_at(const PlaneSet& planes, PlaneKind kind, int x, int y) {
  const Plane& plane = planes.at({kind, {}});
  return {double(plane.channel(0).at(x, y)), double(plane.channel(1).at(x, y)),
          double(plane.channel(2).at(x, y))};
}

}  // namespace holdfast::scenes
