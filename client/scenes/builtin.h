#pragma once

#include <string_view>
#include <vector>

#include "client/scenes/scene.h"

namespace holdfast::scenes {

/// A scene that the renderer knows by name.
struct BuiltinScene {
  std::string_view name;
  std::string_view shows;
  Scene (*make)();
};

const std::vector<BuiltinScene>& builtin_scenes();

/// The built-in scene of that name. Throws InputError that lists the names.
Scene builtin_scene(std::string_view name);

/// A static slatted fence on uneven ground, a rectangle light on an arc behind it: a moving shadow.
Scene fence_scene();
/// A cylinder standing on a plane, a rectangle light moving left.
Scene cylinder_scene();
/// A fence, a polished floor and coloured walls; nothing moves.
Scene static_scene();
/// A block and a ball move over lanes of four roughnesses.
Scene glossy_floor_scene();
/// A post passes in front of a wall that coloured walls light.
Scene occluder_scene();
/// Everything at once; camera, light and an object move.
Scene room_scene();
/// The room at rest, but: the camera cuts at frame 30, a second light is switched on at 60, an
/// object appears at 90.
Scene cut_scene();
/// A block, a ball and a bar move over a floor of one roughness (0..1), for the study of motion
/// vectors; not listed. The camera stands still, or moves along for 20 frames.
Scene roughness_scene(double roughness, bool camera_moves);

/// Shapes that built-in scenes are put together from.
Part box_part(const glm::dvec3& size_m, const glm::dvec3& centre, double turn_deg = 0.0);
Part quad_part(double x_m, double z_m);
Part sphere_part(double radius_m, const glm::dvec3& centre);
Part cylinder_part(double radius_m, double height_m, const glm::dvec3& centre);
/// Vertical slats of 0.58 of the pitch, two rails and a post at each end, centred in x.
std::vector<Part> fence_parts(int slats, double pitch_m, double height_m);
/// One object at rest.
Object still_object(std::uint32_t id, std::string name, const Material& material,
                    std::vector<Part> parts);
/// A one-way trip of `frames` frames along a line, and back again, for ever.
Motion to_and_fro(const glm::dvec3& from, const glm::dvec3& to, double frames);
/// A rectangle light at rest, id 0, that faces `target`.
SceneLight rectangle_at(const glm::dvec3& eye, const glm::dvec3& target, double width_m,
                        double height_m, const glm::dvec3& radiance);

}  // namespace holdfast::scenes
