#include "client/scenes/reference_frame.h"

#include <tbb/parallel_for.h>

#include "client/scenes/glossy.h"
#include "client/scenes/light_target.h"
#include "client/scenes/path.h"
#include "client/scenes/pixel_writer.h"
#include "client/scenes/reference_visibility.h"
#include "client/scenes/sampling.h"

namespace holdfast::scenes {
namespace {

// Apart from the streams of noisy frames.
enum Stream : std::uint64_t { kGlossyStream = 1ull << 32, kIndirectStream };

Rng rng_of(const View& view, int x, int y, std::uint64_t stream) {
  return {view.seed, 0,
          static_cast<std::uint64_t>(y) * static_cast<std::uint64_t>(view.width) +
              static_cast<std::uint64_t>(x),
          stream};
}

glm::dvec3 reference_glossy(const View& view, const Surface& surface, int side, Rng rng) {
  if (!surface.has_lobe()) return glm::dvec3(0.0);
  glm::dvec3 sum(0.0);
  for (int i = 0; i < side * side; ++i) {
    const LobeSample lobe = sample_lobe(surface, stratified(i, side, rng.next2()));
    if (lobe.direction == glm::dvec3(0.0)) continue;
    sum += lobe.weight *
           trace_path(view.scene, view.world, view.lights, surface.origin, lobe.direction, rng)
               .radiance;
  }
  return sum / static_cast<double>(side * side);
}

glm::dvec3 reference_indirect(const View& view, const Surface& surface, int side, Rng rng) {
  glm::dvec3 sum(0.0);
  for (int i = 0; i < side * side; ++i) {
    const glm::dvec3 direction = sample_cosine(surface.normal, stratified(i, side, rng.next2()));
    sum += trace_path(view.scene, view.world, view.lights, surface.origin, direction, rng).radiance;
  }
  return sum / static_cast<double>(side * side);
}

}  // namespace

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

  const int side = strata_side(spp);
  tbb::parallel_for(0, view.height, [&](int y) {
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
        const glm::dvec3 value =
            reference_glossy(view, surface, side, rng_of(view, x, y, kGlossyStream));
        glossy_plane.set(x, y, value);
        sum += specular_factor(surface) * value;
      }
      if (wanted.indirect) {
        const glm::dvec3 value =
            reference_indirect(view, surface, side, rng_of(view, x, y, kIndirectStream));
        indirect_plane.set(x, y, value);
        sum += surface.albedo * value;
      }
      composite.set(x, y, sum);
    }
  });
  return planes;
}

}  // namespace holdfast::scenes
