#include "core/denoiser/scratch.h"

#include <utility>

namespace holdfast {

Scratch::Scratch(int width, int height, const Plan& plan, const Plan::Grid& grid, bool with_debug)
    : noisy(width, height, plan.full.any_radiance || plan.half.any_radiance ? 3 : 1,
            Memory::kLent) {
  grow(width, height, plan, grid, with_debug);
}

void Scratch::grow(int width, int height, const Plan& plan, const Plan::Grid& grid,
                   bool with_debug) {
  if (!grid.any) return;
  grow_rooms(width, height, plan, grid);
  constexpr auto kLent = Memory::kLent;
  const int channels = grid.any_footprint ? kMeasured : kField;
  for (Channels<float>* images : {&measured, &means})
    if (images->count() < channels) *images = Channels<float>(width, height, channels, kLent);
  if (!filter.even) {
    measured_activity = ActivityMap(width, height);
    window = WindowScratch(width, height, kLent);
    filter = FilterScratch(width, height, kLent);
  }
  if (grid.any_footprint && !footprint) footprint = Channels<float>(width, height, 3, kLent);
  if (grid.any_effect && !effect.taps) effect = EffectHistory(width, height, kLent);
  if (plan.recipe.blending == Blending::kExpectedError) {
    if (!blend.bias) blend = BlendScratch(width, height, kLent);
    if (grid.any_radiance && !radiance_blend.means)
      radiance_blend = RadianceBlendScratch(width, height, 2, kLent);
  }
  if (with_debug && !debug) debug = Channels<float>(width, height, kDebugChannels, kLent);
}

void Scratch::grow_rooms(int width, int height, const Plan& plan, const Plan::Grid& grid) {
  const bool packed = plan.history_format == HistoryFormat::kPacked;
  const Memory memory = packed ? Memory::kLent : Memory::kOwned;
  const auto provide = [&](const HistoryRoom& room, int channels) {
    const HistoryExtras extras = plan.extras();
    ComponentHistory now(channels, extras), before(channels, extras);
    if (!room.now.data || room.now.data.memory() != memory)
      now = ComponentHistory(width, height, channels, extras, memory);
    if (packed && !room.before.data)
      before = ComponentHistory(width, height, channels, extras, memory);
    return HistoryRoom{std::move(before), std::move(now)};
  };
  // All that can fail comes first.
  HistoryRoom more_visibility, more_radiance;
  if (grid.any_visibility) more_visibility = provide(visibility, 1);
  if (grid.any_radiance) more_radiance = provide(radiance, 3);
  const auto take = [&](HistoryRoom& room, HistoryRoom& more) {
    if (more.now.data) room.now = std::move(more.now);
    if (more.before.data || !packed) room.before = std::move(more.before);
  };
  if (grid.any_visibility) take(visibility, more_visibility);
  if (grid.any_radiance) take(radiance, more_radiance);
  if (!grid.any_cones) return;
  ConeRoom other(width, height, plan.recipe.indirect_basis, plan.history_format, Memory::kLent);
  if (other.kept.count() != cones.kept.count() || other.updated.count() != cones.updated.count())
    cones = std::move(other);
}

void Scratch::trim(const Plan& plan, const Plan::Grid& grid) noexcept {
  if (!grid.any_radiance) {
    radiance_blend = {};
    radiance = {};
  }
  if (!grid.any_cones) cones = {};
  if (plan.history_format != HistoryFormat::kPacked)
    for (HistoryRoom* room : {&visibility, &radiance}) room->before.data = {};
  if (grid.any) return;
  Channels<float> kept = std::move(noisy);
  *this = Scratch();
  noisy = std::move(kept);
}

}  // namespace holdfast
