#pragma once

#include <cstdint>
#include <map>

#include <glm/glm.hpp>

#include "core/frame/light.h"
#include "core/frame/plane.h"

namespace holdfast {

/// A camera of one frame. Both matrices are absolute, float64 and act on column vectors.
struct Camera {
  glm::dmat4 view_from_world{1.0};
  glm::dmat4 clip_from_view{1.0};  ///< without jitter
  glm::dvec2 jitter_px{0.0};       ///< sample position minus pixel centre, pixels
};

/// Transforms by id. What a frame omits has not moved since the frame before.
using TransformTable = std::map<std::uint32_t, glm::dmat4>;

/// One frame as a client sends it.
struct Frame {
  std::int64_t index = 0;  ///< increases strictly within a session; gaps are allowed
  bool cut = false;        ///< nothing is shared with the frame before: history starts anew
  Camera camera;
  TransformTable objects;  ///< world_from_object, by object id
  TransformTable lights;   ///< world_from_light, by light id
  PlaneSet planes;
};

}  // namespace holdfast
