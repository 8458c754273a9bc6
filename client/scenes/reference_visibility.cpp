#include "client/scenes/reference_visibility.h"

#include <algorithm>

#include "client/scenes/light_batch.h"
#include "client/scenes/light_target.h"
#include "client/scenes/sampling.h"
#include "client/scenes/shadow_ray.h"
#include "core/kernels/parallel.h"

namespace holdfast::scenes {
namespace {

constexpr int kProbeSide = 4;    // 16 samples tell whether a pixel may lie in a penumbra
constexpr int kProbeRadius = 2;  // pixels around that must agree
constexpr std::uint64_t kFirstStream = 1ull << 33;

/// The share, by weight, of side^2 stratified light samples that nothing blocks. `side` is a
/// multiple of 4.
double visible_share(const View& view, const LightState& light, const Surface& surface, int side,
                     Rng rng) {
  const LightTarget target(light, surface);
  if (!target.reaches()) return 1.0;
  if (light.is_delta()) {
    const ShadowRay ray = shadow_ray(surface, sample_light(light, surface.position, {0.5, 0.5}));
    return view.world.occluded(surface.origin, ray.direction, ray.length_m) ? 0.0 : 1.0;
  }
  const LightBatcher batcher(light, surface, target);
  LightBatch batch;
  float u[RayBatch::kSize], v[RayBatch::kSize];
  double lit = 0.0, total = 0.0;
  for (int first = 0; first < side * side; first += RayBatch::kSize) {
    for (int i = 0; i < RayBatch::kSize; ++i) {
      const glm::dvec2 uv = stratified(first + i, side, rng.next2());
      u[i] = static_cast<float>(uv.x);
      v[i] = static_cast<float>(uv.y);
    }
    batcher.fill(u, v, batch);
    const unsigned blocked = view.world.occluded(surface.origin, batch.rays);
    for (int i = 0; i < RayBatch::kSize; ++i) {
      const auto weight = static_cast<double>(batch.weight[i]);
      total += weight;
      if (!(blocked >> i & 1u)) lit += weight;
    }
  }
  return total > 0.0 ? lit / total : 1.0;
}

/// Renders the pixels of row `y` for which `wanted(x, y)` holds.
template <class Wanted>
void render_row(const View& view, std::size_t light, int side, int y, ChannelView<float> out,
                const Wanted& wanted) {
  for (int x = 0; x < view.width; ++x) {
    if (!wanted(x, y)) continue;
    const auto pixel = static_cast<std::uint64_t>(y) * static_cast<std::uint64_t>(view.width) +
                       static_cast<std::uint64_t>(x);
    const Rng rng(view.seed, static_cast<std::uint64_t>(side), pixel, kFirstStream + light);
    const auto primary = primary_at(view, x, y);
    out.at(x, y) = primary ? static_cast<float>(visible_share(view, view.lights[light],
                                                              primary->surface, side, rng))
                           : 1.0f;
  }
}

/// True where the probe is all light or all dark, here and all around.
bool is_settled(ChannelView<const float> probe, int x, int y) {
  const float here = probe.at(x, y);
  if (here != 0.0f && here != 1.0f) return false;
  for (int j = std::max(0, y - kProbeRadius); j <= std::min(probe.height - 1, y + kProbeRadius);
       ++j)
    for (int i = std::max(0, x - kProbeRadius); i <= std::min(probe.width - 1, x + kProbeRadius);
         ++i)
      if (probe.at(i, j) != here) return false;
  return true;
}

}  // namespace

void render_reference_visibility(const View& view, std::size_t light, int spp,
                                 ChannelView<float> out) {
  // A multiple of 4, so that the square divides into batches.
  const int side = (strata_side(spp) + 3) / 4 * 4;
  const auto everywhere = [](int, int) { return true; };
  for_each_index(0, view.height, 1,
                 [&](int y) { render_row(view, light, kProbeSide, y, out, everywhere); });
  if (side <= kProbeSide || view.lights[light].is_delta()) return;
  Channels<float> probe(view.width, view.height, 1);
  for (int y = 0; y < view.height; ++y) std::copy_n(out.row(y), view.width, probe[0].row(y));
  const ChannelView<const float> settled = probe[0];
  const auto open = [&](int x, int y) { return !is_settled(settled, x, y); };
  for_each_index(0, view.height, 1, [&](int y) { render_row(view, light, side, y, out, open); });
}

}  // namespace holdfast::scenes
