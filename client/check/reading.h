#pragma once

#include <string>
#include <vector>

#include "client/check/snapshot.h"
#include "client/measure/image.h"
#include "core/frame/view_geometry.h"

namespace holdfast::check {

/// What the values of `depth` could be.
enum class DepthReading {
  kPlanar,          ///< as the contract has it
  kAlongRay,        ///< distance from the camera to the surface
  kDevice,          ///< clip.z / clip.w
  kDeviceReversed,  ///< 1 - clip.z / clip.w
  kWindow,          ///< (clip.z / clip.w + 1) / 2
  kWindowReversed,  ///< 1 - that
  kCentimetres,
  kMillimetres,
};

/// What the values of `normal` could be.
enum class NormalReading {
  kWorld,  ///< as the contract has it
  kView,
  kAway,  ///< world space, facing away from the camera
  kViewAway,
  kEncodedWorld,  ///< (n + 1) / 2
  kEncodedView,
};

/// Where in the pixel the samples could be.
enum class JitterReading { kGiven, kOpposite, kNone };

/// One way to understand the geometry of a sequence. As it stands: as the contract has it.
struct Reading {
  bool view_inverse = false;  ///< viewFromWorld holds world_from_view
  bool clip_flipped = false;  ///< clipFromView has y downwards
  DepthReading depth = DepthReading::kPlanar;
  NormalReading normal = NormalReading::kWorld;
  JitterReading jitter = JitterReading::kGiven;
};

/// A known mistake: how the reading changes, and how a finding names it.
struct Mistake {
  void (*apply)(Reading&);
  const char* thing;
  const char* name;
  const char* rule;
  const char* found;  ///< what the input seems to be instead: "the opposite sign"
};

/// The known mistakes in the geometry, one change each.
const std::vector<Mistake>& geometry_mistakes();

/// A frame under a reading.
struct Seen {
  Seen(const Snapshot& snapshot, const Reading& reading);

  int width() const { return depth.width; }
  int height() const { return depth.height; }
  float depth_at(int x, int y) const { return depth.values[index(x, y)]; }
  std::uint32_t id_at(int x, int y) const { return ids ? ids.at(x, y) : 0; }
  /// Position of the sample of pixel (x, y) in the image.
  glm::dvec2 sample(int x, int y) const { return glm::dvec2(x + 0.5, y + 0.5) + jitter; }
  /// Camera-relative position of the surface that the pixel shows, world axes, metres.
  glm::dvec3 position(int x, int y) const {
    const glm::dvec2 p = sample(x, y);
    return view.rays.position(p.x, p.y, static_cast<double>(depth_at(x, y)));
  }
  /// The given normal in world space, unit; zero where it has no direction.
  glm::dvec3 normal(int x, int y) const;

  const Snapshot* snapshot;
  ViewGeometry view;
  glm::dvec2 jitter{0};
  measure::Image depth;  ///< planar, metres; 0 where there is no surface
  ChannelView<const std::uint32_t> ids;

 private:
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(depth.width) +
           static_cast<std::size_t>(x);
  }

  NormalReading normal_reading_;
  glm::dmat3 world_from_view_{1};
};

}  // namespace holdfast::check
