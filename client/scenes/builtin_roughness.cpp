#include "client/scenes/builtin.h"

namespace holdfast::scenes {
namespace {

/// Glows and reflects nothing, so that paths end where they arrive: the only noise is the lobe's.
Material glowing(const glm::dvec3& radiance) {
  return {.albedo = glm::dvec3(0.0), .emission = radiance};
}

/// Every other tile of a chequered wall of 12 by 4, each 0.6 m wide.
std::vector<Part> wall_tiles(int odd) {
  std::vector<Part> parts;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 12; ++column)
      if ((row + column) % 2 == odd)
        parts.push_back(box_part({0.6, 0.6, 0.2}, {0.6 * column - 3.3, 0.6 * row + 0.3, -2.6}));
  return parts;
}

/// Turns by `degrees` about `axis` on its way along a line, and back again, for ever.
Motion tumbling(const glm::dvec3& from, const glm::dvec3& to, const glm::dvec3& axis,
                double degrees, double frames) {
  Motion motion = to_and_fro(from, to, frames);
  motion.keys.back().transform.rotation = glm::angleAxis(glm::radians(degrees), axis);
  return motion;
}

void add_moving(Scene& scene, std::string name, const glm::dvec3& radiance, std::vector<Part> parts,
                const Motion& motion) {
  const auto id = static_cast<std::uint32_t>(scene.objects.size() + 1);
  scene.objects.push_back(still_object(id, std::move(name), glowing(radiance), std::move(parts)));
  scene.objects.back().motion = motion;
}

}  // namespace

Scene roughness_scene(double roughness, bool camera_moves) {
  Scene scene;
  scene.name = "roughness";
  scene.components = {false, true, false};
  scene.sky = {{0.55, 0.58, 0.64}, {0.24, 0.34, 0.56}};
  scene.camera.vertical_fov_deg = 38.0;
  scene.camera.motion = Motion(look_at({0.0, 2.2, 4.4}, {0.0, 0.0, 0.1}));
  if (camera_moves)
    scene.camera.motion.keys.push_back({20.0, look_at({0.9, 2.0, 4.1}, {0.1, 0.0, 0.1}), false});

  const Material floor{
      .albedo = glm::dvec3(0.1), .roughness = roughness, .specular = glm::dvec3(0.55)};
  scene.objects = {still_object(1, "floor", floor, {quad_part(16.0, 16.0)}),
                   still_object(2, "wall", glowing({0.46, 0.42, 0.36}), wall_tiles(0)),
                   still_object(3, "dark tiles", glowing({0.17, 0.19, 0.24}), wall_tiles(1))};
  const Motion slide = to_and_fro({-1.6, 0.0, -0.9}, {1.6, 0.0, -0.9}, 40.0);
  const glm::dvec3 slab(0.5, 0.25, 0.5);
  add_moving(scene, "sliding block", {0.80, 0.12, 0.06},
             {box_part(slab, {0, 0.14, 0}, 30.0), box_part(slab, {0, 0.64, 0}, 30.0)}, slide);
  add_moving(scene, "its light slabs", {0.85, 0.65, 0.15},
             {box_part(slab, {0, 0.39, 0}, 30.0), box_part(slab, {0, 0.89, 0}, 30.0)}, slide);
  add_moving(scene, "hovering ball", {0.06, 0.42, 0.38}, {sphere_part(0.3, glm::dvec3(0.0))},
             to_and_fro({1.6, 1.1, -0.1}, {-1.4, 0.4, 0.5}, 40.0));
  add_moving(scene, "tumbling bar", {0.75, 0.70, 0.14},
             {box_part({1.1, 0.16, 0.16}, glm::dvec3(0.0))},
             tumbling({-1.5, 0.9, 0.3}, {-0.3, 1.1, -0.5}, {0.0, 0.6, 0.8}, 170.0, 40.0));
  return scene;
}

}  // namespace holdfast::scenes
