#pragma once

#include <glm/glm.hpp>

#include "core/frame/scene_motion.h"

namespace holdfast {

/// One shadowed sample, carried to the previous frame. Points are relative to the previous camera,
/// metres, world axes.
template <class T>
struct ShadowSample {
  glm::vec<3, T> surface;  ///< s' = T_s^-1 s
  glm::vec<3, T> normal;   ///< n', unit
  glm::vec<3, T> blocker;  ///< b' = T_b^-1 b
  glm::vec<4, T> light;    ///< l': a point (w = 1), or the direction towards the light (w = 0)
};

/// Where the ray from l' through b' meets the receiver's previous plane:
///   X = b' + tau (b' - l'),  tau = ((s' - b') . n') / ((b' - l') . n')
/// (TRMV eq. 3-5, written from the blocker so that tau >= 0 says that the blocker lies between the
/// light and the receiver.) Returns false unless the ray descends onto the front of the receiver,
/// (b' - l') . n' < -1e-4 |b' - l'|, and tau >= 0 is finite; then `hit` is untouched.
template <class T>
bool shadow_previous_point(const ShadowSample<T>& sample, glm::vec<3, T>& hit) {
  const glm::vec<3, T> towards =
      sample.light.w * sample.blocker - glm::vec<3, T>(sample.light);  // b' - l', or -l'
  const T descent = glm::dot(towards, sample.normal);
  const T length = glm::length(towards);
  if (!(descent < T(-1e-4) * length)) return false;
  const T tau = glm::dot(sample.surface - sample.blocker, sample.normal) / descent;
  if (!(tau >= T(-1e-4)) || !(tau < T(1e6))) return false;
  hit = sample.blocker + tau * towards;
  return true;
}

/// How far the shadow's blocker has moved before the light since the previous frame, seen from the
/// surface, in widths of the light: what a visibility can have changed by where the blocker's edge
/// is straight. `ratio` is the blocker's share of the way to the light now (metres for a
/// direction); `half_axes` are the light's in the previous frame, zero where it has no extent.
/// Ours.
///   e = s' + (b' - s') / ratio - l'       sweep = |(e.a_k / (2 a_k.a_k))_k|
template <class T>
T shadow_sweep(const ShadowSample<T>& sample, T ratio, const glm::mat<3, 3, T>& half_axes) {
  const glm::vec<3, T> moved = (sample.blocker - sample.surface) / std::max(ratio, T(1e-6)) +
                               sample.light.w * sample.surface - glm::vec<3, T>(sample.light);
  T sum = T(0);
  for (int k = 0; k < 3; ++k) {
    const T square_m = glm::dot(half_axes[k], half_axes[k]);
    const T widths = square_m > T(0) ? glm::dot(moved, half_axes[k]) / (T(2) * square_m) : T(0);
    sum += widths * widths;
  }
  return std::sqrt(sum);
}

inline constexpr float kFalloffSigma = 0.1f;  // rad; ours, TRMV gives no number

/// TRMV's trust in a shadow vector on uneven ground: G(theta - 90 deg), a Gaussian with peak 1 and
/// sigma 0.1 rad, of the angle theta between the receiver's previous normal and the line from the
/// intersection to the surface `seen` at its pixel. 1 where they agree within `footprint_m`.
template <class T>
T planarity_falloff(const glm::vec<3, T>& hit, const glm::vec<3, T>& seen,
                    const glm::vec<3, T>& normal, T footprint_m) {
  constexpr T kSigma = T(kFalloffSigma);
  const glm::vec<3, T> line = seen - hit;
  const T distance = glm::length(line);
  if (distance <= footprint_m) return T(1);
  const T angle = std::asin(glm::clamp(glm::dot(line, normal) / distance, T(-1), T(1)));
  return std::exp(-angle * angle / (T(2) * kSigma * kSigma));
}

}  // namespace holdfast
