#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <glm/glm.hpp>

#include "client/scenes/light_state.h"
#include "client/scenes/scene.h"
#include "client/scenes/surface.h"
#include "client/scenes/world.h"
#include "core/frame/frame.h"

namespace holdfast::scenes {

/// Everything that is fixed while one frame is traced.
struct View {
  const Scene& scene;
  const World& world;
  std::vector<LightState> lights;
  Camera camera;
  int width = 0, height = 0;  ///< pixels
  std::uint64_t seed = 0;
  std::int64_t frame = 0;
};

/// The surface that a pixel's centre shows.
struct Primary {
  Surface surface;
  std::uint32_t object_id = 0;
  std::size_t object = 0;     ///< index in Scene::objects
  double depth_view_m = 0.0;  ///< planar, > 0
};

/// The camera of a scene at a time in frames, for an image of this shape. No jitter.
Camera camera_at(const Scene& scene, double frame, int width, int height);

/// World-space unit direction from the camera through a pixel's centre.
glm::dvec3 pixel_direction(const View& view, int x, int y);

/// What pixel (x, y) shows; nothing for sky. Surfaces nearer than the near plane are seen too.
std::optional<Primary> primary_at(const View& view, int x, int y);

}  // namespace holdfast::scenes
