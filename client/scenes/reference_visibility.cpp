#include "client/scenes/reference_visibility.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>

#include "client/scenes/light_target.h"
#include "client/scenes/sampling.h"
#include "client/scenes/shadow_ray.h"

namespace holdfast::scenes {
namespace {

constexpr int kProbeSide = 8;    // 64 samples tell whether a pixel may lie in a penumbra
constexpr int kProbeRadius = 2;  // pixels around that must agree
constexpr std::uint64_t kFirstStream = 1ull << 33;

/// The weighted share of side^2 stratified light samples that nothing blocks.
double visible_share(const View& view, const LightState& light, const Surface& surface, int side,
                     Rng rng) {
  const LightTarget target(light, surface);
  if (!target.reaches()) return 1.0;
  if (light.is_delta()) side = 1;
  std::array<glm::dvec3, 8> directions;
  std::array<double, 8> lengths, weights;
  double lit = 0.0, total = 0.0;
  std::size_t count = 0;
  const auto trace = [&] {
    const unsigned blocked = view.world.occluded8(surface.origin, std::span(directions).first(count),
                                                  std::span(lengths).first(count));
    for (std::size_t i = 0; i < count; ++i) {
      total += weights[i];
      if (!(blocked >> i & 1u)) lit += weights[i];
    }
    count = 0;
  };
  for (int i = 0; i < side * side; ++i) {
    LightSample sample;
    const glm::dvec2 jitter = light.is_delta() ? glm::dvec2(0.5) : rng.next2();
    weights[count] = target.weight(stratified(i, side, jitter), sample);
    if (weights[count] <= 0.0) continue;
    const ShadowRay ray = shadow_ray(surface, sample);
    directions[count] = ray.direction;
    lengths[count] = ray.length_m;
    if (++count == directions.size()) trace();
  }
  if (count > 0) trace();
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
  for (int j = std::max(0, y - kProbeRadius); j <= std::min(probe.height - 1, y + kProbeRadius); ++j)
    for (int i = std::max(0, x - kProbeRadius); i <= std::min(probe.width - 1, x + kProbeRadius);
         ++i)
      if (probe.at(i, j) != here) return false;
  return true;
}

}  // namespace

void render_reference_visibility(const View& view, std::size_t light, int spp,
                                 ChannelView<float> out) {
  const int side = strata_side(spp);
  const auto everywhere = [](int, int) { return true; };
  const int first_side = std::min(side, kProbeSide);
  tbb::parallel_for(0, view.height,
                    [&](int y) { render_row(view, light, first_side, y, out, everywhere); });
  if (side <= kProbeSide || view.lights[light].is_delta()) return;
  Channels<float> probe(view.width, view.height, 1);
  for (int y = 0; y < view.height; ++y) std::copy_n(out.row(y), view.width, probe[0].row(y));
  const ChannelView<const float> settled = probe[0];
  const auto open = [&](int x, int y) { return !is_settled(settled, x, y); };
  tbb::parallel_for(0, view.height, [&](int y) { render_row(view, light, side, y, out, open); });
}

}  // namespace holdfast::scenes
