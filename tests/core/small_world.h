#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include <glm/gtc/matrix_transform.hpp>

#include "core/frame/frame.h"
#include "core/frame/guides.h"

namespace holdfast::test {

inline constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
inline constexpr float kInf = std::numeric_limits<float>::infinity();

/// Reproducible numbers that do not depend on the standard library (PCG-RXS-M-XS 32).
class Random {
 public:
  explicit Random(std::uint32_t seed) : state_(seed * 747796405u + 2891336453u) {}
  std::uint32_t bits() {
    state_ = state_ * 747796405u + 2891336453u;
    const std::uint32_t word = ((state_ >> ((state_ >> 28) + 4)) ^ state_) * 277803737u;
    return (word >> 22) ^ word;
  }
  /// Uniform in [0, 1).
  double uniform() { return static_cast<double>(bits()) * 0x1p-32; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  float real(float low = 0.0f, float high = 1.0f) {
    return low + (high - low) * static_cast<float>(bits() >> 8) * 0x1p-24f;
  }
  glm::dvec3 in_box(double half) {
    const double x = uniform(-half, half), y = uniform(-half, half), z = uniform(-half, half);
    return {x, y, z};
  }

 private:
  std::uint32_t state_;
};

inline Camera perspective_camera(int width, int height, glm::dvec3 eye = glm::dvec3(0),
                                 glm::dvec3 towards = {0, 0, -1}) {
  Camera camera;
  camera.view_from_world = glm::lookAt(eye, eye + towards, glm::dvec3(0, 1, 0));
  camera.clip_from_view =
      glm::perspective(0.9, static_cast<double>(width) / static_cast<double>(height), 0.1, 100.0);
  return camera;
}

inline Camera orthographic_camera(int width, int height, glm::dvec3 eye = glm::dvec3(0),
                                  glm::dvec3 towards = {0, 0, -1}) {
  Camera camera;
  camera.view_from_world = glm::lookAt(eye, eye + towards, glm::dvec3(0, 1, 0));
  const double half = 2.0, aspect = static_cast<double>(width) / static_cast<double>(height);
  camera.clip_from_view = glm::ortho(-half * aspect, half * aspect, -half, half, 0.1, 100.0);
  return camera;
}

/// Any rigid transform.
inline glm::dmat4 random_rigid(Random& random, double angle, double distance) {
  const glm::dvec3 shift = random.in_box(distance), axis = random.in_box(1) + glm::dvec3(1e-3);
  return glm::rotate(glm::translate(glm::dmat4(1), shift), random.uniform(-angle, angle),
                     glm::normalize(axis));
}

/// Guides of `camera` without any surface.
inline Guides empty_guides(const Camera& camera, int width, int height) {
  Guides guides(width, height);
  guides.view = ViewGeometry(camera, width, height);
  guides.rays = guides.view.rays.cast<float>();
  return guides;
}

inline void set_pixel(Guides& guides, int x, int y, float depth, glm::vec3 normal,
                      std::uint32_t id = 0) {
  guides.depth_normal[0].at(x, y) = depth;
  for (int axis = 0; axis < 3; ++axis) guides.depth_normal[1 + axis].at(x, y) = normal[axis];
  guides.id[0].at(x, y) = id;
}

/// A wall at `depth` metres that faces a camera which looks down -Z.
inline Guides wall(const Camera& camera, int width, int height, float depth = 5.0f,
                   std::uint32_t id = 1) {
  Guides guides = empty_guides(camera, width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) set_pixel(guides, x, y, depth, {0, 0, 1}, id);
  return guides;
}

inline void fill(ChannelView<float> channel, float value) {
  for (int y = 0; y < channel.height; ++y)
    for (int x = 0; x < channel.width; ++x) channel.at(x, y) = value;
}

inline void fill_random(ChannelView<float> channel, Random& random, float low, float high) {
  for (int y = 0; y < channel.height; ++y)
    for (int x = 0; x < channel.width; ++x) channel.at(x, y) = random.real(low, high);
}

/// Puts NaN between the end of each row and the start of the next, where nothing may read: all of
/// it, or where there is an apron what is beyond.
inline void poison_padding(ChannelView<float> channel) {
  const std::ptrdiff_t apron = channel.stride - channel.width < kApron ? 0 : kApron;
  for (int y = 0; y < channel.height; ++y)
    for (std::ptrdiff_t x = channel.width + apron; x < channel.stride - apron; ++x)
      channel.row(y)[x] = kNaN;
}

/// Whether the apron of an image, if its rows have one, is still 0.
inline bool has_clean_apron(ChannelView<const float> channel) {
  if (channel.stride - channel.width < kApron) return true;
  const auto is_clean = [](const float* at) {
    return std::all_of(at, at + kApron, [](float value) { return value == 0.0f; });
  };
  for (int y = 0; y < channel.height; ++y)
    if (!is_clean(channel.row(y) + channel.width) || !is_clean(channel.row(y) - kApron))
      return false;
  return true;
}

}  // namespace holdfast::test
