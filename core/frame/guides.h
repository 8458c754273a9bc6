#pragma once

#include "core/frame/plane.h"
#include "core/frame/view_geometry.h"

namespace holdfast {

/// The geometry of one frame after sanitising, as filters and reprojection read it.
/// Depth is 0 where there is no surface, and the normal is 0 there; elsewhere depth is positive and
/// finite and the normal is of unit length.
struct Guides {
  Channels<float> depth_normal;  ///< planar view depth in metres, then the normal's X, Y, Z
  Channels<std::uint32_t> id;    ///< object ids, 0 where none was given
  Channels<float> roughness;     ///< perceptual, 0..1; empty where no component needs it
  Channels<float> motion;        ///< given motion_px X, Y; empty where the client gives none
  float normal_error = 0;  ///< what a part of a normal may be off by, where it was kept in few bits
  ViewGeometry view;
  PixelRays<float> rays;  ///< of `view`

  Guides() = default;
  Guides(int width, int height, Memory memory = Memory::kOwned)
      : depth_normal(width, height, 4, memory), id(width, height, 1, memory) {}

  /// Calls `visit` for all images of `g`, a Guides.
  static void each_image(auto& g, auto&& visit) {
    visit(g.depth_normal);
    visit(g.id);
    visit(g.roughness);
    visit(g.motion);
  }
  std::size_t bytes() const {
    return depth_normal.bytes() + id.bytes() + roughness.bytes() + motion.bytes();
  }
  ChannelView<const float> depth() const { return depth_normal[0]; }
  ChannelView<const float> normal(int axis) const { return depth_normal[1 + axis]; }
  glm::vec3 normal_at(int x, int y) const {
    return {normal(0).at(x, y), normal(1).at(x, y), normal(2).at(x, y)};
  }
  /// Perceptual roughness, 0..1; that of a mirror where none was given.
  float roughness_at(int x, int y) const { return roughness ? roughness[0].at(x, y) : 0.0f; }
  /// Camera-relative position of the surface seen by pixel (x, y), metres, world axes.
  glm::vec3 position_at(int x, int y) const {
    return rays.position(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f,
                         depth().at(x, y));
  }
};

}  // namespace holdfast
