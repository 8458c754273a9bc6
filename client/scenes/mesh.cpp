#include "client/scenes/mesh.h"

#include <cmath>
#include <numbers>

namespace holdfast::scenes {
namespace {

using Index = std::uint32_t;

glm::vec3 on_circle(int step, int segments, double radius, double y) {
  const double phi = 2.0 * std::numbers::pi * step / segments;
  return glm::vec3(glm::dvec3(radius * std::cos(phi), y, -radius * std::sin(phi)));
}

void add_disk(Mesh& mesh, double radius, double y, bool up, int segments) {
  const auto base = static_cast<Index>(mesh.positions.size());
  mesh.positions.emplace_back(0.0f, static_cast<float>(y), 0.0f);
  for (int i = 0; i < segments; ++i) mesh.positions.push_back(on_circle(i, segments, radius, y));
  mesh.normals.resize(mesh.positions.size(), glm::vec3(0.0f));
  for (int i = 0; i < segments; ++i) {
    const Index a = base + 1 + static_cast<Index>(i);
    const Index b = base + 1 + static_cast<Index>((i + 1) % segments);
    mesh.triangles.push_back(up ? glm::uvec3(base, a, b) : glm::uvec3(base, b, a));
  }
}

}  // namespace

void Mesh::append(const Mesh& other) {
  const auto base = static_cast<Index>(positions.size());
  positions.insert(positions.end(), other.positions.begin(), other.positions.end());
  normals.insert(normals.end(), other.normals.begin(), other.normals.end());
  for (const glm::uvec3& t : other.triangles) triangles.push_back(t + base);
}

void Mesh::transform(const glm::dmat4& matrix) {
  const glm::dmat3 normal_matrix = glm::transpose(glm::inverse(glm::dmat3(matrix)));
  for (glm::vec3& p : positions) p = glm::vec3(matrix * glm::dvec4(p, 1.0));
  for (glm::vec3& n : normals)
    if (n != glm::vec3(0.0f)) n = glm::vec3(glm::normalize(normal_matrix * glm::dvec3(n)));
}

Mesh box_mesh(const glm::dvec3& size_m) {
  Mesh mesh;
  for (int axis = 0; axis < 3; ++axis) {
    for (int side = -1; side <= 1; side += 2) {
      const auto base = static_cast<Index>(mesh.positions.size());
      for (int corner = 0; corner < 4; ++corner) {
        const int u = corner == 1 || corner == 2 ? 1 : -1, v = corner >= 2 ? 1 : -1;
        glm::dvec3 p;
        p[axis] = side;
        p[(axis + 1) % 3] = u * side;
        p[(axis + 2) % 3] = v;
        mesh.positions.emplace_back(0.5 * p * size_m);
      }
      mesh.triangles.emplace_back(base, base + 1, base + 2);
      mesh.triangles.emplace_back(base, base + 2, base + 3);
    }
  }
  mesh.normals.resize(mesh.positions.size(), glm::vec3(0.0f));
  return mesh;
}

Mesh quad_mesh(double x_m, double z_m) {
  const glm::dvec3 h(0.5 * x_m, 0.0, 0.5 * z_m);
  Mesh mesh;
  mesh.positions = {glm::vec3(-h.x, 0, h.z), glm::vec3(h.x, 0, h.z), glm::vec3(h.x, 0, -h.z),
                    glm::vec3(-h.x, 0, -h.z)};
  mesh.normals.resize(4, glm::vec3(0.0f));
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

Mesh sphere_mesh(double radius_m, int segments) {
  const int rings = segments / 2;
  Mesh mesh;
  for (int ring = 0; ring <= rings; ++ring) {
    const double theta = std::numbers::pi * ring / rings;
    for (int i = 0; i <= segments; ++i) {
      const glm::vec3 p =
          on_circle(i, segments, radius_m * std::sin(theta), radius_m * std::cos(theta));
      mesh.positions.push_back(p);
      mesh.normals.push_back(glm::normalize(p));
    }
  }
  const auto row = static_cast<Index>(segments + 1);
  for (Index ring = 0; ring < static_cast<Index>(rings); ++ring) {
    for (Index i = 0; i + 1 < row; ++i) {
      const Index a = ring * row + i, b = a + row;
      if (ring > 0) mesh.triangles.emplace_back(a, b, a + 1);
      if (ring + 1 < static_cast<Index>(rings)) mesh.triangles.emplace_back(a + 1, b, b + 1);
    }
  }
  return mesh;
}

Mesh cylinder_mesh(double radius_m, double height_m, int segments) {
  Mesh mesh;
  for (int i = 0; i < segments; ++i) {
    for (double side : {-0.5, 0.5}) {
      mesh.positions.push_back(on_circle(i, segments, radius_m, side * height_m));
      mesh.normals.push_back(on_circle(i, segments, 1.0, 0.0));
    }
  }
  const auto count = static_cast<Index>(2 * segments);
  for (Index i = 0; i < count; i += 2) {
    const Index j = (i + 2) % count;
    mesh.triangles.emplace_back(i, j, j + 1);
    mesh.triangles.emplace_back(i, j + 1, i + 1);
  }
  add_disk(mesh, radius_m, 0.5 * height_m, true, segments);
  add_disk(mesh, radius_m, -0.5 * height_m, false, segments);
  return mesh;
}

Mesh mesh_of_object(const Object& object) {
  Mesh all;
  for (const Part& part : object.parts) {
    Mesh mesh;
    switch (part.shape) {
      case PartShape::kBox: mesh = box_mesh(part.size_m); break;
      case PartShape::kSphere: mesh = sphere_mesh(part.radius_m); break;
      case PartShape::kCylinder: mesh = cylinder_mesh(part.radius_m, part.height_m); break;
      case PartShape::kQuad: mesh = quad_mesh(part.size_m.x, part.size_m.z); break;
      case PartShape::kMesh: mesh = read_obj(part.file); break;
    }
    mesh.transform(part.placement.matrix());
    all.append(mesh);
  }
  return all;
}

}  // namespace holdfast::scenes
