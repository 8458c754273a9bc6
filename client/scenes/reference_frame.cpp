#include "client/scenes/reference_frame.h"

#include <optional>

#include "client/scenes/glossy.h"
#include "client/scenes/light_target.h"
#include "client/scenes/pixel_writer.h"
#include "client/scenes/reference_radiance.h"
#include "client/scenes/reference_visibility.h"
#include "core/kernels/parallel.h"

namespace holdfast::scenes {

PlaneSet render_reference(const View& view, int spp) {
  const SceneComponents& wanted = view.scene.components;
  PlaneSet planes;
  std::vector<ChannelView<const float>> visibility;
  if (wanted.visibility) {
    for (std::size_t k = 0; k < view.lights.size(); ++k) {
      const PlaneId id = PlaneId::of_light(PlaneKind::kVisibility, view.lights[k].light.id);
      const auto channel = planes.add(id, view.width, view.height).channel(0);
      render_reference_visibility(view, k, spp, channel);
      visibility.push_back(channel);
    }
  }
  PixelWriter glossy_plane, indirect_plane;
  if (wanted.glossy) glossy_plane = {planes, {PlaneKind::kGlossy, {}}, view.width, view.height};
  if (wanted.indirect)
    indirect_plane = {planes, {PlaneKind::kIndirect, {}}, view.width, view.height};
  const PixelWriter composite(planes, {PlaneKind::kComposite, {}}, view.width, view.height);

  std::optional<ReferenceRadiance> radiance;
  if (wanted.glossy || wanted.indirect) radiance.emplace(view, spp);
  for_each_index(0, view.height, 1, [&](int y) {
    for (int x = 0; x < view.width; ++x) {
      const auto primary = primary_at(view, x, y);
      if (!primary) {
        composite.set(x, y, view.scene.sky.radiance(pixel_direction(view, x, y)));
        continue;
      }
      const Surface& surface = primary->surface;
      glm::dvec3 sum = surface.emission;
      for (std::size_t k = 0; k < visibility.size(); ++k)
        sum += LightTarget(view.lights[k], surface).unshadowed() *
               static_cast<double>(visibility[k].at(x, y));
      if (wanted.glossy) {
        const glm::dvec3 value = radiance->glossy(x, y, surface);
        glossy_plane.set(x, y, value);
        sum += specular_factor(surface) * value;
      }
      if (wanted.indirect) {
        const glm::dvec3 value = radiance->indirect(x, y, surface);
        indirect_plane.set(x, y, value);
        sum += surface.albedo * value;
      }
      composite.set(x, y, sum);
    }
  });
  return planes;
}

}  // namespace holdfast::scenes
