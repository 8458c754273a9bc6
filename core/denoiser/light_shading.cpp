#include "core/denoiser/light_shading.h"

#include <algorithm>

#include "core/kernels/parallel.h"
#include "core/shading/direct_light.h"

namespace holdfast {
namespace {

/// The material planes of a frame; null where there is none.
struct Materials {
  const Plane* albedo;
  const Plane* specular;
  const Plane* roughness;
};

float usable_share(float v) { return v > 0.0f ? (v <= 1.0f ? v : 1.0f) : 0.0f; }

glm::vec3 colour_at(const Plane* plane, int x, int y) {
  if (plane == nullptr) return glm::vec3(0.0f);
  return {usable_share(plane->channel(0).at(x, y)), usable_share(plane->channel(1).at(x, y)),
          usable_share(plane->channel(2).at(x, y))};
}

/// Unit direction from a pixel's surface to the viewer: for an orthographic camera the same for
/// all.
glm::vec3 to_viewer(const PixelRays<float>& rays, int x, int y) {
  const float px = static_cast<float>(x) + 0.5f, py = static_cast<float>(y) + 0.5f;
  return -glm::normalize(rays.position(px, py, 1.0f) - rays.position(px, py, 0.0f));
}

void shade_row(const Guides& guides, const PlacedLight<float>& light, const Materials& materials,
               int y, Plane& out) {
  for (int x = 0; x < out.width(); ++x) {
    glm::vec3 colour(0.0f);
    if (guides.depth().at(x, y) > 0.0f) {
      ShadingPoint<float> point;
      point.position = guides.position_at(x, y);
      point.normal = guides.normal_at(x, y);
      point.to_viewer = to_viewer(guides.rays, x, y);
      point.albedo = colour_at(materials.albedo, x, y);
      point.specular = colour_at(materials.specular, x, y);
      if (materials.roughness != nullptr)
        point.roughness = usable_share(materials.roughness->channel(0).at(x, y));
      colour = unshadowed_light(light, point);
    }
    for (int c = 0; c < 3; ++c) out.channel(c).at(x, y) = colour[c];
  }
}

}  // namespace

void shade_lights(const Guides& guides, const SceneMotion& scene, const std::vector<Light>& lights,
                  const Plan& plan, const PlaneSet& planes, PlaneSet& out) {
  Materials materials{planes.find({PlaneKind::kAlbedo, {}}), nullptr, nullptr};
  if (plan.shaded_lobe) {
    materials.specular = planes.find({PlaneKind::kSpecular, {}});
    materials.roughness = planes.find({PlaneKind::kRoughness, {}});
  }
  for (const Light& light : lights) {
    Plane* unshadowed = out.find(PlaneId::of_light(PlaneKind::kUnshadowed, light.id));
    if (unshadowed == nullptr) continue;
    const auto placed = place_light<float>(light, scene.light(light.id).relative_from_light);
    for_each_row(unshadowed->height(),
                 [&](int y) { shade_row(guides, placed, materials, y, *unshadowed); });
  }
}

}  // namespace holdfast
