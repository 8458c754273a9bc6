#include "core/frame/view_geometry.h"

#include <cmath>
#include <string>

#include "core/frame/conventions.h"
#include "core/frame/error.h"

namespace holdfast {
namespace {

/// The view-space xy of a pixel position at planar depth d: solves ndc.xy * clip.w = clip.xy.
glm::dvec2 view_xy(const glm::dmat4& clip_from_view, glm::dvec2 ndc, double depth) {
  const glm::dmat4& m = clip_from_view;
  const auto row = [&](int r) { return glm::dvec4(m[0][r], m[1][r], m[2][r], m[3][r]); };
  const glm::dvec4 ex = row(0) - ndc.x * row(3);
  const glm::dvec4 ey = row(1) - ndc.y * row(3);
  const glm::dmat2 lhs(ex.x, ey.x, ex.y, ey.y);
  const glm::dvec2 rhs(ex.z * depth - ex.w, ey.z * depth - ey.w);
  return glm::inverse(lhs) * rhs;
}

void check_matrix(const glm::dmat4& m, const char* name) {
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r)
      if (!std::isfinite(m[c][r]))
        throw InputError(std::string("camera ") + name, "must be finite", std::to_string(m[c][r]));
  if (const double det = glm::determinant(m); !std::isfinite(1.0 / det))
    throw InputError(std::string("camera ") + name, "must be invertible",
                     "of determinant " + std::to_string(det));
}

}  // namespace

ViewGeometry::ViewGeometry(const Camera& camera, int image_width, int image_height)
    : width(image_width), height(image_height) {
  check_matrix(camera.view_from_world, "viewFromWorld");
  check_matrix(camera.clip_from_view, "clipFromView");
  const glm::dmat4 world_from_view = glm::inverse(camera.view_from_world);
  origin = glm::dvec3(world_from_view[3]);
  const glm::dmat3 axes(world_from_view);
  const glm::dvec2 size(image_width, image_height);

  // xy(p, d) is affine in the pixel position, with coefficients affine in depth.
  const auto xy = [&](glm::dvec2 p, double d) {
    return view_xy(camera.clip_from_view, ndc_from_pixel(p, size.x, size.y), d);
  };
  const double growth =
      glm::distance(xy({1, 0}, 2), xy({0, 0}, 2)) / glm::distance(xy({1, 0}, 1), xy({0, 0}, 1));
  const bool perspective = growth > 1.5;
  rays.near_weight = perspective ? 0 : 1;
  rays.far_weight = perspective ? 1 : 0;
  const glm::dvec2 o = xy({0, 0}, 1);
  const glm::dvec2 dx = (xy({size.x, 0}, 1) - o) / size.x;
  const glm::dvec2 dy = (xy({0, size.y}, 1) - o) / size.y;
  rays.lateral_0 = axes * glm::dvec3(o, 0);
  rays.lateral_x = axes * glm::dvec3(dx, 0);
  rays.lateral_y = axes * glm::dvec3(dy, 0);
  rays.forward = axes * glm::dvec3(0, 0, -1);
  pixel_angle = std::sqrt(glm::length(dx) * glm::length(dy));

  glm::dmat4 pixel_from_clip(0.0);
  pixel_from_clip[0][0] = 0.5 * size.x;
  pixel_from_clip[3][0] = 0.5 * size.x;
  pixel_from_clip[1][1] = -0.5 * size.y;
  pixel_from_clip[3][1] = 0.5 * size.y;
  pixel_from_clip[3][3] = 1;
  const glm::dmat4 view_from_relative{glm::dmat3(camera.view_from_world)};
  const glm::dmat4 clip = camera.clip_from_view * view_from_relative;
  pixel_from_relative = pixel_from_clip * clip;
  for (int c = 0; c < 4; ++c) pixel_from_relative[c][2] = -view_from_relative[c][2];
}

ViewGeometry ViewGeometry::halved() const {
  ViewGeometry half = *this;
  half.width = (width + 1) / 2;
  half.height = (height + 1) / 2;
  half.rays.lateral_x *= 2.0;
  half.rays.lateral_y *= 2.0;
  half.pixel_from_relative = halved_pixels(pixel_from_relative);
  half.pixel_angle *= 2.0;
  return half;
}

}  // namespace holdfast
