#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "client/scenes/motion.h"
#include "core/frame/light.h"

namespace holdfast::scenes {

/// A second albedo in a chequered pattern of object space, in the plane that faces the normal most.
struct Checker {
  glm::dvec3 albedo{0.5};  ///< of every other square, 0..1
  double size_m = 0.5;     ///< edge of a square, > 0

  bool operator==(const Checker&) const = default;
};

/// A diffuse base below a GGX coat. The lobes are independent of each other.
struct Material {
  glm::dvec3 albedo{0.7};  ///< diffuse, 0..1
  std::optional<Checker> checker = std::nullopt;
  double roughness = 1.0;    ///< perceptual, 0..1
  glm::dvec3 specular{0.0};  ///< reflectance at normal incidence (F0), 0..1; 0 = no lobe
  glm::dvec3 emission{0.0};  ///< radiance, >= 0

  bool operator==(const Material&) const = default;
};

enum class PartShape : std::uint8_t { kBox, kSphere, kCylinder, kQuad, kMesh };

/// One shape of an object, centred on the object's origin before `placement`.
struct Part {
  PartShape shape = PartShape::kBox;
  glm::dvec3 size_m{1.0};      ///< box: edges; quad: x and z, its normal is +Y, y is unused
  double radius_m = 0.5;       ///< sphere, cylinder
  double height_m = 1.0;       ///< cylinder, along Y
  std::filesystem::path file;  ///< mesh: a Wavefront OBJ file
  Transform placement;

  bool operator==(const Part&) const = default;
};

/// A rigid object. Ids are unique and not 0.
struct Object {
  std::uint32_t id = 1;
  std::string name;
  Material material;
  std::vector<Part> parts;
  Motion motion;            ///< world_from_object
  double from_frame = 0.0;  ///< absent before this time, in frames

  bool operator==(const Object&) const = default;
};

/// A light. Never seen by rays and never a blocker.
struct SceneLight {
  Light light;
  glm::dvec3 emission{1.0};  ///< rectangle, disk, sphere: radiance; point: radiant intensity;
                             ///< directional: irradiance on a surface that faces it
  Motion motion;             ///< world_from_light; scale is 1
  double from_frame = 0.0;   ///< dark before this time, in frames
};

/// Radiance of directions that meet no surface: from the horizon (and below) to the zenith.
struct Sky {
  glm::dvec3 horizon{0.0};
  glm::dvec3 zenith{0.0};

  glm::dvec3 radiance(const glm::dvec3& direction) const {
    const double up = direction.y > 0.0 ? direction.y : 0.0;
    return horizon + (zenith - horizon) * up;
  }
  bool operator==(const Sky&) const = default;
};

struct SceneCamera {
  double vertical_fov_deg = 40.0;  ///< 0 < fov < 180
  double near_m = 0.05;
  double far_m = 1000.0;
  Motion motion;  ///< world_from_camera; a jump is a cut
};

/// What a scene asks to have filtered; planes of the others are not rendered.
struct SceneComponents {
  bool visibility = true;
  bool glossy = true;
  bool indirect = true;

  bool operator==(const SceneComponents&) const = default;
};

/// A scene as a person describes it. Lengths in metres, times in frames.
struct Scene {
  std::string name;
  double frame_rate = 30.0;  ///< frames per second, > 0
  SceneComponents components;
  Sky sky;
  glm::dvec3 ambient{0.0};  ///< noise-free incident radiance from above, added to `emission` as
                            ///< albedo * ambient * (1 + normal.y)/2: for scenes without indirect
  SceneCamera camera;
  std::vector<Object> objects;
  std::vector<SceneLight> lights;
};

/// True if the scene has anything to write into the plane `emission`.
bool glows(const Scene& scene);

}  // namespace holdfast::scenes
