#pragma once

#include <optional>
#include <vector>

#include <glm/glm.hpp>

#include "client/scenes/light_state.h"
#include "client/scenes/scene.h"
#include "client/scenes/world.h"

namespace holdfast::scenes {

/// What a secondary ray finds.
struct Incident {
  glm::dvec3 radiance{0.0};
  std::optional<Hit> hit;  ///< none = sky
};

/// Radiance that arrives at `origin` along a unit direction: a path of up to three surfaces, with
/// one shadow ray to each light at each. Surfaces met on the way are shaded as diffuse ones
/// that reflect albedo + specular. Lights themselves are not seen. `Numbers` is `Rng` or
/// `PathPoints`.
template <class Numbers>
Incident trace_path(const Scene& scene, const World& world, const std::vector<LightState>& lights,
                    const glm::dvec3& origin, const glm::dvec3& direction, Numbers& numbers);

}  // namespace holdfast::scenes
