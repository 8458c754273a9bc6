#include "client/scenes/builtin.h"

#include <string>

#include "core/frame/error.h"

namespace holdfast::scenes {

const std::vector<BuiltinScene>& builtin_scenes() {
  static const std::vector<BuiltinScene> scenes{
      {"fence", "static fence, moving light: a moving shadow", fence_scene},
      {"cylinder", "standing cylinder, light moving left", cylinder_scene},
      {"static", "nothing moves; shadows, glossy and indirect light", static_scene},
      {"glossy-floor", "objects moving over lanes of four roughnesses", glossy_floor_scene},
      {"occluder", "a post passing before a wall in coloured indirect light", occluder_scene},
      {"room", "everything at once, camera moving", room_scene},
      {"cut", "camera cut at 30, light on at 60, object appears at 90", cut_scene},
  };
  return scenes;
}

Scene builtin_scene(std::string_view name) {
  std::string names;
  for (const BuiltinScene& scene : builtin_scenes()) {
    if (scene.name == name) return scene.make();
    names += (names.empty() ? "" : ", ") + std::string(scene.name);
  }
  throw InputError("scene", "must be a scene JSON file or one of " + names, std::string(name));
}

Part box_part(const glm::dvec3& size_m, const glm::dvec3& centre, double turn_deg) {
  Part part;
  part.shape = PartShape::kBox;
  part.size_m = size_m;
  part.placement.translation = centre;
  part.placement.rotation = glm::angleAxis(glm::radians(turn_deg), glm::dvec3(0, 1, 0));
  return part;
}

Part quad_part(double x_m, double z_m) {
  Part part;
  part.shape = PartShape::kQuad;
  part.size_m = {x_m, 0.0, z_m};
  return part;
}

Part sphere_part(double radius_m, const glm::dvec3& centre) {
  Part part;
  part.shape = PartShape::kSphere;
  part.radius_m = radius_m;
  part.placement.translation = centre;
  return part;
}

Part cylinder_part(double radius_m, double height_m, const glm::dvec3& centre) {
  Part part;
  part.shape = PartShape::kCylinder;
  part.radius_m = radius_m;
  part.height_m = height_m;
  part.placement.translation = centre;
  return part;
}

std::vector<Part> fence_parts(int slats, double pitch_m, double height_m) {
  std::vector<Part> parts;
  const double width = 0.58 * pitch_m;
  const double half = 0.5 * pitch_m * (slats - 1);
  for (int i = 0; i < slats; ++i) {
    const double x = i * pitch_m - half;
    const double h = height_m * (1.0 + 0.06 * (i % 3));  // uneven tops break the regular shadow
    parts.push_back(box_part({width, h, 0.03}, {x, 0.5 * h, 0.0}));
  }
  for (double y : {0.3, 0.75})
    parts.push_back(box_part({2.0 * half + pitch_m, 0.08, 0.03}, {0.0, y * height_m, -0.031}));
  for (double side : {-1.0, 1.0})
    parts.push_back(box_part({0.12, 1.25 * height_m, 0.12},
                             {side * (half + pitch_m), 0.625 * height_m, -0.02}));
  return parts;
}

Object still_object(std::uint32_t id, std::string name, const Material& material,
                    std::vector<Part> parts) {
  Object object;
  object.id = id;
  object.name = std::move(name);
  object.material = material;
  object.parts = std::move(parts);
  return object;
}

Motion to_and_fro(const glm::dvec3& from, const glm::dvec3& to, double frames) {
  Motion motion(Transform{.translation = from});
  motion.keys.push_back({frames, Transform{.translation = to}, false});
  motion.repeat = Repeat::kMirror;
  return motion;
}

SceneLight rectangle_at(const glm::dvec3& eye, const glm::dvec3& target, double width_m,
                        double height_m, const glm::dvec3& radiance) {
  SceneLight out;
  out.light = {.id = 0, .shape = LightShape::kRectangle, .width = width_m, .height = height_m};
  out.emission = radiance;
  out.motion = Motion(look_at(eye, target));
  return out;
}

}  // namespace holdfast::scenes
