#pragma once

#include <cstdint>

#include <glm/glm.hpp>

namespace holdfast::scenes {

/// Eight rays from one origin, component by component. Directions need not be unit: a ray reaches
/// from the origin to origin + length * direction.
struct RayBatch {
  static constexpr int kSize = 8;
  alignas(32) float x[kSize], y[kSize], z[kSize];  ///< directions
  alignas(32) float length[kSize];
};

/// Where the rays of a batch meet objects first; of single precision, but enough to look things up.
struct HitBatch {
  static constexpr std::uint32_t kNone = ~0u;
  alignas(32) std::uint32_t object[RayBatch::kSize];  ///< index in Scene::objects, or kNone
  alignas(32) float distance[RayBatch::kSize];        ///< in lengths of the direction
  alignas(32) float normal_x[RayBatch::kSize], normal_y[RayBatch::kSize],
      normal_z[RayBatch::kSize];  ///< of the triangle, of any length, on any side

  struct Hit {
    std::uint32_t object;
    float distance;
    glm::vec3 normal;
  };
  Hit at(std::uint32_t i) const {
    return {object[i], distance[i], {normal_x[i], normal_y[i], normal_z[i]}};
  }
};

}  // namespace holdfast::scenes
