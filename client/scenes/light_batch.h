#pragma once

#include "client/scenes/light_target.h"
#include "client/scenes/ray_batch.h"

namespace holdfast::scenes {

/// Shadow rays to 8 light samples and the samples' weights, in single precision: what the reference
/// spends its time on.
struct LightBatch {
  RayBatch rays;
  float weight[RayBatch::kSize];  ///< f of `LightTarget`, up to one factor for all batches
};

/// Makes batches for one light and one surface. Both must outlive it, and the light must not be a
/// point or a direction.
class LightBatcher {
 public:
  LightBatcher(const LightState& light, const Surface& surface, const LightTarget& target);

  /// Rays to the samples (u[i], v[i]) in [0,1]^2.
  void fill(const float* u, const float* v, LightBatch& out) const;

 private:
  void fill_rectangle(const float* u, const float* v, LightBatch& out) const;
  void fill_any(const float* u, const float* v, LightBatch& out) const;

  const LightState& light_;
  const Surface& surface_;
  const LightTarget& target_;
  glm::vec3 first_{0.0f};  ///< from the surface's ray origin to sample (0, 0)
  glm::vec3 along_u_{0.0f}, along_v_{0.0f};
  glm::vec3 origin_shift_{0.0f};  ///< from the surface's position to its ray origin
  glm::vec3 normal_{0.0f};
};

}  // namespace holdfast::scenes
