#pragma once

namespace holdfast::scenes {

/// Eight rays from one origin, component by component. Directions need not be unit: a ray reaches
/// from the origin to origin + length * direction.
struct RayBatch {
  static constexpr int kSize = 8;
  alignas(32) float x[kSize], y[kSize], z[kSize];  ///< directions
  alignas(32) float length[kSize];
};

}  // namespace holdfast::scenes
