#include "client/scenes/path.h"

#include <limits>
#include <numbers>

#include "client/scenes/path_points.h"
#include "client/scenes/rng.h"
#include "client/scenes/sampling.h"
#include "client/scenes/surface.h"

namespace holdfast::scenes {
namespace {

constexpr int kMostSurfaces = 3;
constexpr double kFar = std::numeric_limits<double>::infinity();

/// Irradiance from all lights by one sample of each.
template <class Numbers>
glm::dvec3 sample_irradiance(const World& world, const std::vector<LightState>& lights,
                             const Surface& surface, Numbers& numbers) {
  glm::dvec3 sum(0.0);
  for (const LightState& light : lights) {
    const glm::dvec2 uv = numbers.next2();
    if (!light.is_on()) continue;
    const LightSample sample = sample_irradiance_of(light, surface.origin, uv);
    const double cosine = glm::dot(surface.normal, sample.direction);
    if (cosine <= 0.0 || sample.geometry <= 0.0) continue;
    if (!world.occluded(surface.origin, sample.direction, sample.distance_m))
      sum += light.emission * (cosine * sample.geometry);
  }
  return sum;
}

}  // namespace

template <class Numbers>
Incident trace_path(const Scene& scene, const World& world, const std::vector<LightState>& lights,
                    const glm::dvec3& origin, const glm::dvec3& direction, Numbers& numbers) {
  Incident out;
  glm::dvec3 throughput(1.0), from = origin, along = direction;
  for (int depth = 0; depth < kMostSurfaces; ++depth) {
    const std::optional<Hit> hit = world.nearest(from, along, kFar);
    if (depth == 0) out.hit = hit;
    if (!hit) {
      out.radiance += throughput * scene.sky.radiance(along);
      break;
    }
    const Surface surface = surface_at(scene, *hit, along);
    const glm::dvec3 reflectance = glm::min(surface.albedo + surface.specular, glm::dvec3(0.95));
    out.radiance += throughput * surface.emission;
    throughput *= reflectance;
    out.radiance +=
        throughput * sample_irradiance(world, lights, surface, numbers) * std::numbers::inv_pi;
    from = surface.origin;
    along = sample_cosine(surface.normal, numbers.next2());
  }
  return out;
}

template Incident trace_path(const Scene&, const World&, const std::vector<LightState>&,
                             const glm::dvec3&, const glm::dvec3&, Rng&);
template Incident trace_path(const Scene&, const World&, const std::vector<LightState>&,
                             const glm::dvec3&, const glm::dvec3&, PathPoints&);

}  // namespace holdfast::scenes
