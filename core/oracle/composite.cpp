#include "core/oracle/composite.h"

#include <algorithm>
#include <cmath>

#include "core/shading/direct_light.h"

namespace holdfast::oracle {
namespace {

constexpr double kLargestRadiance = double{1e15f};

/// A material value kept within 0..1; NaN becomes 0.
double usable_share(float v) { return v > 0.0f ? std::min(double{v}, 1.0) : 0.0; }

glm::dvec3 colour_at(const Plane* plane, int x, int y) {
  if (plane == nullptr) return glm::dvec3(0);
  return {usable_share(plane->channel(0).at(x, y)), usable_share(plane->channel(1).at(x, y)),
          usable_share(plane->channel(2).at(x, y))};
}

/// A factor that is not finite counts as 0.
double usable_factor(float v) {
  return std::isfinite(v) ? std::clamp(double{v}, -kLargestRadiance, kLargestRadiance) : 0.0;
}

double value_of(const Term& term, int x, int y, int c) {
  const double signal = term.signal->at(x, y, std::min(c, term.signal->channels() - 1));
  if (term.given_factor != nullptr)
    return usable_factor(term.given_factor->channel(c).at(x, y)) * signal;
  return term.own_factor != nullptr ? term.own_factor->at(x, y, c) * signal : signal;
}

}  // namespace

Image shade(const Surfaces& now, const Light& light, const LightPlaces& places, bool with_lobe,
            const PlaneSet& planes) {
  const auto placed = place_light<double>(light, places.now);
  const Plane* albedo = planes.find({PlaneKind::kAlbedo, {}});
  const Plane* specular = with_lobe ? planes.find({PlaneKind::kSpecular, {}}) : nullptr;
  const Plane* roughness = with_lobe ? planes.find({PlaneKind::kRoughness, {}}) : nullptr;
  const PixelRays<double>& rays = now.view.rays;
  Image out(now.width, now.height, 3);
  for_each_pixel(now.width, now.height, [&](int x, int y) {
    if (!now.any(x, y)) return;
    ShadingPoint<double> point;
    point.position = now.position(x, y);
    point.normal = now.normal_at(x, y);
    point.to_viewer = -glm::normalize(rays.position(x + 0.5, y + 0.5, 1.0) -
                                      rays.position(x + 0.5, y + 0.5, 0.0));
    point.albedo = colour_at(albedo, x, y);
    point.specular = colour_at(specular, x, y);
    if (roughness != nullptr) point.roughness = usable_share(roughness->channel(0).at(x, y));
    const glm::dvec3 colour = unshadowed_light(placed, point);
    for (int c = 0; c < 3; ++c) out.at(x, y, c) = colour[c];
  });
  return out;
}

Image compose(const Surfaces& now, std::span<const Term> terms, const Plane* emission) {
  Image out(now.width, now.height, 3);
  for_each_pixel(now.width, now.height, [&](int x, int y) {
    for (int c = 0; c < 3; ++c) {
      double& sum = out.at(x, y, c);
      if (now.any(x, y))
        for (const Term& term : terms) sum += value_of(term, x, y, c);
      if (emission != nullptr) sum += usable_factor(emission->channel(c).at(x, y));
    }
  });
  return out;
}

}  // namespace holdfast::oracle
