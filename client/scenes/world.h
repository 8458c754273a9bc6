#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <glm/glm.hpp>

#include "client/scenes/mesh.h"
#include "client/scenes/ray_batch.h"
#include "client/scenes/scene.h"

namespace holdfast::scenes {

/// Where a ray meets an object. World space.
struct Hit {
  double distance_m = 0.0;
  std::size_t object = 0;            ///< index in Scene::objects
  glm::dvec3 position{0.0};          ///< on the triangle
  glm::dvec3 normal{0.0};            ///< interpolated, unit, faces the ray's origin
  glm::dvec3 geometric_normal{0.0};  ///< of the triangle, unit, faces the ray's origin
  glm::dvec3 object_position{0.0};   ///< object space
  glm::dvec3 object_normal{0.0};     ///< object space, of the triangle
};

/// The objects of a scene at one time, ready for ray queries. Queries may run in parallel;
/// `set_time` may not run beside them.
class World {
 public:
  /// Builds all meshes, at time 0. `scene` must outlive the world. Throws InputError as `read_obj`.
  explicit World(const Scene& scene);
  ~World();

  /// Moves every object to its place at a time in frames.
  void set_time(double frame);

  /// The nearest hit of the ray within `max_m` metres. `direction` is unit.
  std::optional<Hit> nearest(const glm::dvec3& origin, const glm::dvec3& direction,
                             double max_m) const;
  /// The same for a batch of rays from one origin, to the ends that the batch states.
  void nearest(const glm::dvec3& origin, const RayBatch& rays, HitBatch& out) const;
  /// True if something lies on the ray before `max_m` metres. `direction` is unit.
  bool occluded(const glm::dvec3& origin, const glm::dvec3& direction, double max_m) const;
  /// The same for a batch of rays from one origin; bit i of the result is ray i.
  unsigned occluded(const glm::dvec3& origin, const RayBatch& rays) const;

  const Mesh& mesh(std::size_t object) const;
  const glm::dmat4& world_from_object(std::size_t object) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// A ray's origin moved off its surface so that it does not meet the surface again: by 1e-4 of the
/// largest coordinate (at least of 1 m) along the geometric normal.
glm::dvec3 offset_origin(const glm::dvec3& position, const glm::dvec3& geometric_normal);

}  // namespace holdfast::scenes
