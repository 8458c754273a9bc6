#pragma once

#include <optional>

#include "client/stability/world.h"

namespace holdfast::stability {

/// What a ray meets, in units of the scene.
struct Hit {
  double distance = 0;
  glm::dvec3 normal{0};  ///< unit, towards where the ray came from
  std::uint32_t id = 0;
};

/// The world's surfaces at one frame.
class Surfaces {
 public:
  Surfaces(const World& world, const glm::dmat4& scene_from_box);

  /// The nearest surface beyond `from` along the unit `direction`, in double.
  std::optional<Hit> cast(glm::dvec3 from, glm::dvec3 direction) const;
  /// Radiance that leaves the point a ray meets, or that of the sky.
  glm::dvec3 radiance(glm::dvec3 from, glm::dvec3 direction, const std::optional<Hit>& hit) const;

 private:
  const World& world_;
  glm::dmat4 box_from_scene_{1};
  bool has_box_ = true;  ///< false where its transform is singular
};

}  // namespace holdfast::stability
