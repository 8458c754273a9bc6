#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "core/frame/plane.h"
#include "core/frame/view_geometry.h"
#include "core/oracle/image.h"

namespace holdfast::oracle {

/// What a frame shows, after repair: depth 0 and normal 0 where there is no surface, else a finite
/// positive depth in metres and a unit normal.
struct Surfaces {
  int width = 0, height = 0;
  Image depth, normal;
  std::vector<std::uint32_t> ids;
  Image roughness;  ///< perceptual, 0..1; empty where no component needs it
  Image motion;     ///< given motion_px X, Y; empty where the client gives none, or none needs it
  ViewGeometry view;

  bool inside(int x, int y) const { return x >= 0 && y >= 0 && x < width && y < height; }
  bool any(int x, int y) const { return depth.at(x, y) > 0; }
  std::uint32_t id(int x, int y) const {
    return ids[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
               static_cast<std::size_t>(x)];
  }
  glm::dvec3 normal_at(int x, int y) const {
    return {normal.at(x, y, 0), normal.at(x, y, 1), normal.at(x, y, 2)};
  }
  double roughness_at(int x, int y) const { return roughness ? roughness.at(x, y) : 0.0; }
  /// Of the surface at (x, y), relative to the camera, metres.
  glm::dvec3 position(int x, int y) const {
    return view.rays.position(x + 0.5, y + 0.5, depth.at(x, y));
  }
  std::size_t bytes() const {
    return depth.bytes() + normal.bytes() + ids.size() * sizeof(std::uint32_t) + roughness.bytes() +
           motion.bytes();
  }
  /// Width of a pixel at a planar depth, metres.
  double pixel_width(double planar_depth) const {
    return view.pixel_angle * (view.rays.near_weight + view.rays.far_weight * planar_depth);
  }
};

/// Repairs the geometry of a frame as frame_input.h says. Counts of repaired values are added.
struct RepairedGeometry {
  std::uint64_t depth = 0, normal = 0, roughness = 0;
};
Surfaces load_surfaces(const PlaneSet& planes, const ViewGeometry& view, bool with_roughness,
                       bool with_motion, RepairedGeometry& repaired);

/// A component's plane: negative or not finite becomes 0 (visibility: 1), too large the largest
/// radiance (visibility: 1). `repaired` receives the number of such values.
Image load_signal(const Plane& plane, std::uint64_t& repaired);

}  // namespace holdfast::oracle
