#pragma once

#include <filesystem>
#include <vector>

#include <glm/glm.hpp>

#include "client/scenes/scene.h"

namespace holdfast::scenes {

/// Triangles of object space, metres, counter-clockwise from outside.
struct Mesh {
  std::vector<glm::vec3> positions;
  std::vector<glm::vec3> normals;  ///< one per position; zero = flat
  std::vector<glm::uvec3> triangles;

  /// Appends another mesh.
  void append(const Mesh& other);
  /// Moves every position and normal.
  void transform(const glm::dmat4& matrix);
};

Mesh box_mesh(const glm::dvec3& size_m);
/// In the plane y = 0, normal +Y.
Mesh quad_mesh(double x_m, double z_m);
/// `segments` around, half as many from pole to pole; smooth.
Mesh sphere_mesh(double radius_m, int segments = 96);
/// Along Y, with caps; smooth side.
Mesh cylinder_mesh(double radius_m, double height_m, int segments = 128);

/// A Wavefront OBJ file: v, vn and f with polygons and negative indices; every other key is
/// skipped. Throws InputError with file and line where it cannot be read.
Mesh read_obj(const std::filesystem::path& file);

/// All parts of an object in one mesh. Throws as `read_obj`.
Mesh mesh_of_object(const Object& object);

}  // namespace holdfast::scenes
