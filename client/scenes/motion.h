#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

namespace holdfast::scenes {

/// Scale, then rotate, then translate. Metres.
struct Transform {
  glm::dvec3 translation{0.0};
  glm::dquat rotation{1.0, 0.0, 0.0, 0.0};  ///< unit; w, x, y, z
  glm::dvec3 scale{1.0};

  glm::dmat4 matrix() const;
  bool operator==(const Transform&) const = default;
};

/// At `eye` with local -Z towards `target` and local +Y upwards. For a line of sight along world Y,
/// world +Z takes the place of up.
Transform look_at(const glm::dvec3& eye, const glm::dvec3& target);

/// Linear between two: translation and scale by line, rotation by the shorter arc. `t` in 0..1.
Transform interpolate(const Transform& a, const Transform& b, double t);

struct Key {
  double frame = 0.0;
  Transform transform;
  bool jump = false;  ///< holds the key before until this time instead of moving towards this key

  bool operator==(const Key&) const = default;
};

/// What happens outside the times of the keys.
enum class Repeat : std::uint8_t {
  kHold,    ///< the first or last key
  kLoop,    ///< starts again at the first key
  kMirror,  ///< runs back and forth
};

/// A key-framed motion. Keys in strictly ascending time, at least one.
struct Motion {
  std::vector<Key> keys = std::vector<Key>(1);
  Repeat repeat = Repeat::kHold;

  Motion() = default;
  explicit Motion(const Transform& still) { keys.front().transform = still; }

  /// The transform at a time in frames.
  Transform at(double frame) const;
  /// True if a jump lies in (from, to]; in frames, from < to.
  bool jumps(double from, double to) const;

  bool operator==(const Motion&) const = default;
};

}  // namespace holdfast::scenes
