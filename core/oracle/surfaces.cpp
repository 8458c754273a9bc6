#include "core/oracle/surfaces.h"

#include <cmath>
#include <limits>

namespace holdfast::oracle {
namespace {

constexpr double kLargestRadiance = double{1e15f};
constexpr double kLargestVisibility = double{1e6f};
constexpr double kShortestNormal = double{1e-18f}, kLongestNormal = double{1e18f};

void load_depth(const Plane& plane, Surfaces& out, std::uint64_t& repaired) {
  out.depth = Image(out.width, out.height, 1);
  for_each_pixel(out.width, out.height, [&](int x, int y) {
    const double depth = double{plane.channel(0).at(x, y)};
    if (std::isnan(depth)) ++repaired;
    out.depth.at(x, y) = depth > 0 && std::isfinite(depth) ? depth : 0.0;
  });
}

void load_normals(const Plane& plane, Surfaces& out, std::uint64_t& repaired) {
  out.normal = Image(out.width, out.height, 3);
  const glm::dvec3 towards = -glm::normalize(out.view.rays.forward);
  for_each_pixel(out.width, out.height, [&](int x, int y) {
    if (!out.any(x, y)) return;
    glm::dvec3 normal(plane.channel(0).at(x, y), plane.channel(1).at(x, y),
                      plane.channel(2).at(x, y));
    const double length = glm::length(normal);
    const bool usable = length >= kShortestNormal && length <= kLongestNormal;
    if (!usable) ++repaired;
    normal = usable ? normal / length : towards;
    for (int axis = 0; axis < 3; ++axis) out.normal.at(x, y, axis) = normal[axis];
  });
}

void load_roughness(const Plane& plane, Surfaces& out, std::uint64_t& repaired) {
  out.roughness = Image(out.width, out.height, 1);
  for_each_pixel(out.width, out.height, [&](int x, int y) {
    const double given = double{plane.channel(0).at(x, y)};
    const bool usable = given >= 0 && given <= 1;
    if (!usable) ++repaired;
    out.roughness.at(x, y) = usable ? given : (given < 0 ? 0.0 : 1.0);
  });
}

}  // namespace

Surfaces load_surfaces(const PlaneSet& planes, const ViewGeometry& view, bool with_roughness,
                       bool with_motion, RepairedGeometry& repaired) {
  Surfaces out;
  out.view = view;
  out.width = view.width;
  out.height = view.height;
  load_depth(planes.at({PlaneKind::kDepth, {}}), out, repaired.depth);
  load_normals(planes.at({PlaneKind::kNormal, {}}), out, repaired.normal);
  out.ids.assign(static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height), 0);
  if (const Plane* ids = planes.find({PlaneKind::kObjectId, {}})) {
    std::size_t k = 0;
    for_each_pixel(out.width, out.height,
                   [&](int x, int y) { out.ids[k++] = ids->ids().at(x, y); });
  }
  if (with_roughness)
    load_roughness(planes.at({PlaneKind::kRoughness, {}}), out, repaired.roughness);
  if (with_motion) {
    const Plane& motion = planes.at({PlaneKind::kMotion, {}});
    out.motion = Image(out.width, out.height, 2);
    for_each_pixel(out.width, out.height, [&](int x, int y) {
      for (int c = 0; c < 2; ++c) out.motion.at(x, y, c) = double{motion.channel(c).at(x, y)};
    });
  }
  return out;
}

Image load_signal(const Plane& plane, std::uint64_t& repaired) {
  const bool visibility = plane.id().kind == PlaneKind::kVisibility;
  const double unknown = visibility ? 1.0 : 0.0;
  const double most = visibility ? kLargestVisibility : kLargestRadiance;
  Image out(plane.width(), plane.height(), plane.channels());
  for_each_pixel(out.width(), out.height(), [&](int x, int y) {
    for (int c = 0; c < out.channels(); ++c) {
      const double given = double{plane.channel(c).at(x, y)};
      double& used = out.at(x, y, c);
      used = given;
      if (given >= 0 && given <= most) continue;
      ++repaired;
      const bool too_large = given > most && std::isfinite(given);
      used = too_large && !visibility ? kLargestRadiance : unknown;
    }
  });
  return out;
}

}  // namespace holdfast::oracle
