#pragma once

#include <glm/glm.hpp>

namespace holdfast {

/// Channels of a field: what single samples say of the effect around them. All are 0 where a sample
/// says nothing, so that local means of the channels, divided by that of kFieldValid, are means
/// over the samples that do.
///   kFieldValid      1
///   kFieldRatio      shadows: distance of the blocker over that of the light sample, 0..1; for a
///                    directional light the distance of the blocker in metres
///   kFieldPrecision  E, F, G in 1 / px^2: the effect's footprint, half the inverse covariance of
///                    the Gaussian over which it is smooth
enum EffectFieldChannel {
  kFieldValid,
  kFieldRatio,
  kFieldPrecision,
  kEffectFieldChannels = kFieldPrecision + 3
};

/// Half the inverse of a covariance (xx, xy, yy) in px^2, as E, F, G.
inline glm::vec3 precision_of_covariance(float xx, float xy, float yy) {
  const float determinant = xx * yy - xy * xy;
  const float scale = 0.5f / (determinant > 1e-12f ? determinant : 1e-12f);
  return {yy * scale, -xy * scale, xx * scale};
}

}  // namespace holdfast
