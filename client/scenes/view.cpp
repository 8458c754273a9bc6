#include "client/scenes/view.h"

#include <cmath>
#include <limits>

#include <glm/gtc/matrix_transform.hpp>

#include "core/frame/conventions.h"

namespace holdfast::scenes {

Camera camera_at(const Scene& scene, double frame, int width, int height) {
  Camera camera;
  camera.view_from_world = glm::inverse(scene.camera.motion.at(frame).matrix());
  camera.clip_from_view = glm::perspective(glm::radians(scene.camera.vertical_fov_deg),
                                           static_cast<double>(width) / height, scene.camera.near_m,
                                           scene.camera.far_m);
  return camera;
}

glm::dvec3 pixel_direction(const View& view, int x, int y) {
  const glm::dvec2 ndc =
      ndc_from_pixel(glm::dvec2(x + 0.5, y + 0.5), double(view.width), double(view.height));
  const glm::dmat4& p = view.camera.clip_from_view;
  const glm::dvec3 in_view((ndc.x + p[2][0]) / p[0][0], (ndc.y + p[2][1]) / p[1][1], -1.0);
  return glm::normalize(glm::transpose(glm::dmat3(view.camera.view_from_world)) * in_view);
}

std::optional<Primary> primary_at(const View& view, int x, int y) {
  const glm::dmat3 world_from_view = glm::transpose(glm::dmat3(view.camera.view_from_world));
  const glm::dvec3 eye = -(world_from_view * glm::dvec3(view.camera.view_from_world[3]));
  const glm::dvec3 direction = pixel_direction(view, x, y);
  const auto hit = view.world.nearest(eye, direction, std::numeric_limits<double>::infinity());
  if (!hit) return std::nullopt;
  const double depth = -(view.camera.view_from_world * glm::dvec4(hit->position, 1.0)).z;
  if (!(depth > 0.0)) return std::nullopt;
  return Primary{surface_at(view.scene, *hit, direction), view.scene.objects[hit->object].id,
                 hit->object, depth};
}

}  // namespace holdfast::scenes
