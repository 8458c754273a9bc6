#include "client/scenes/surface.h"

#include <cmath>

namespace holdfast::scenes {
namespace {

bool odd_square(const glm::dvec3& position, const glm::dvec3& normal, double size_m) {
  const glm::dvec3 a = glm::abs(normal);
  const int axis = a.x > a.y && a.x > a.z ? 0 : a.y > a.z ? 1 : 2;
  const double u = std::floor(position[(axis + 1) % 3] / size_m);
  const double v = std::floor(position[(axis + 2) % 3] / size_m);
  return std::fmod(std::abs(u + v), 2.0) > 0.5;
}

}  // namespace

Surface surface_at(const Scene& scene, const Hit& hit, const glm::dvec3& direction) {
  const Material& material = scene.objects[hit.object].material;
  Surface s;
  s.position = hit.position;
  s.origin = offset_origin(hit.position, hit.geometric_normal);
  s.normal = hit.normal;
  s.geometric_normal = hit.geometric_normal;
  s.to_viewer = -direction;
  s.albedo = material.albedo;
  if (material.checker &&
      odd_square(hit.object_position, hit.object_normal, material.checker->size_m))
    s.albedo = material.checker->albedo;
  s.specular = material.specular;
  s.roughness = material.roughness;
  s.emission = material.emission + s.albedo * scene.ambient * (0.5 + 0.5 * hit.normal.y);
  return s;
}

}  // namespace holdfast::scenes
