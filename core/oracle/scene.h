#pragma once

#include <cstdint>
#include <map>

#include <glm/glm.hpp>

#include "core/frame/frame.h"
#include "core/frame/view_geometry.h"

namespace holdfast::oracle {

/// How one rigid object moved between the previous and the current frame. Points are relative to
/// the camera of their frame, metres.
struct Motion {
  glm::dmat4 previous_from_now{1}, now_from_previous{1};  ///< of the world
  glm::dmat3 normal{1};                                   ///< previous from current normals
  glm::dvec3 origin{0}, previous_origin{0};               ///< of the cameras, in the world
  bool at_rest = false;   ///< object and camera both stand still: motion is exactly 0
  bool appeared = false;  ///< in the current frame: nobody knows whether it was there
  bool traceable = true;  ///< false for a singular transform: nothing corresponds

  glm::dvec3 point_then(const glm::dvec3& now) const {
    if (!traceable) return now;
    return glm::dvec3(previous_from_now * glm::dvec4(now + origin, 1)) - previous_origin;
  }
  glm::dvec3 point_now(const glm::dvec3& then) const {
    return glm::dvec3(now_from_previous * glm::dvec4(then + previous_origin, 1)) - origin;
  }
  glm::dvec3 normal_then(const glm::dvec3& now) const { return glm::normalize(normal * now); }
};

/// A light relative to the cameras of both frames.
struct LightPlaces {
  glm::dmat4 now{1}, then{1};
  bool at_rest = true;  ///< in the world
};

/// Follows cameras, objects and lights from frame to frame. A frame's tables list only what moved.
class Scene {
 public:
  /// Takes the next frame, whose matrices have been checked.
  void advance(const Frame& frame, int width, int height);

  /// The same motion, seen by cameras with half the pixels.
  Scene halved() const;

  const ViewGeometry& view() const { return view_; }
  const ViewGeometry& previous_view() const { return previous_view_; }
  /// Objects that are in no table, or have not moved, are the static world.
  const Motion& motion(std::uint32_t object_id) const;
  LightPlaces light(std::uint32_t light_id) const;
  /// True when camera and all objects stand still.
  bool geometry_at_rest() const { return geometry_still_ && static_.at_rest; }
  /// True when the lights stand still, too, and nothing has been placed for the first time.
  bool at_rest() const;

 private:
  struct Track {
    glm::dmat4 now{1}, before{1};
    bool appeared = false;
  };
  using Tracks = std::map<std::uint32_t, Track>;
  bool follow(Tracks& tracks, const TransformTable& moved, bool first);
  Motion motion_of(const Track& track) const;

  Tracks objects_, lights_;
  Camera camera_;
  ViewGeometry view_, previous_view_;
  bool has_past_ = false, camera_at_rest_ = false, appeared_ = false;
  bool geometry_still_ = true;  ///< no object moves
  Motion static_;
  std::map<std::uint32_t, Motion> moving_;  ///< or new
};

}  // namespace holdfast::oracle
