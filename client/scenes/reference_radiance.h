#pragma once

#include "client/scenes/path_points.h"
#include "client/scenes/radiance_cache.h"
#include "client/scenes/ray_batch.h"
#include "client/scenes/view.h"

namespace holdfast::scenes {

/// Converged glossy and indirect light of single pixels, at points of Sobol's.
///
/// Glossy light is the mean of paths. For indirect light, paths from all pixels fill a cache of
/// what surfaces send out, which each pixel gathers in cells that it sees at 1/32 rad or less, so
/// that a sample costs a ray and all pixels share the paths. That blurs what lights a pixel by so
/// little that no shift of its mean could be measured (less than 2e-4; client/scenes/DESIGN.md).
class ReferenceRadiance {
 public:
  /// Fills the cache with a 16th of `spp` paths a pixel, at least one, if the scene has indirect
  /// light.
  ReferenceRadiance(const View& view, int spp);

  /// Incident radiance of the lobe, without its `specular_factor`: `spp` samples.
  glm::dvec3 glossy(int x, int y, const Surface& surface) const;
  /// Irradiance / pi: `spp` samples, rounded up to a multiple of 8.
  glm::dvec3 indirect(int x, int y, const Surface& surface) const;

 private:
  std::uint64_t seed_of(int x, int y, std::uint64_t stream) const;
  double typical_distance() const;
  void fill_cache();
  glm::dvec3 gathered(const Surface& surface, const glm::vec3& direction, const HitBatch::Hit& hit,
                      PathPoints& points) const;

  const View& view_;
  int spp_;
  RadianceCache cache_;
};

}  // namespace holdfast::scenes
