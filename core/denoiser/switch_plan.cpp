#include "core/denoiser/switch_plan.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "core/spatial/upsample.h"

namespace holdfast {
namespace {

/// Of a component whose resolution is to change: from half to full.
void upsample_history(const ComponentHistory& half, const Guides& half_guides,
                      const Guides& full_guides, ComponentHistory& full) {
  const Channels<float> nothing(full.data.width(), full.data.height(), 1);
  Upsampling upsampling(full.data.width(), full.data.height());
  upsampling.find(full_guides, half_guides);
  for (int c = 0; c < half.data.count(); ++c)
    upsampling.run({1, {half.data[c]}, {nothing[0]}, {full.data[c]}});
}

/// A filter of `next` that keeps the same in another format.
ComponentFilter in_other_format(const DenoiserConfig& config, const Plan& next, std::size_t k,
                                const Guides* last, const PlannedParts& parts) {
  const Plan::Entry& entry = next.components[k];
  ComponentFilter filter(next, entry, entry.half ? half_size(config.width) : config.width,
                         entry.half ? half_size(config.height) : config.height);
  if (last == nullptr) return filter;
  ComponentHistory history = parts.filters[k].kept();
  filter.keep(history);
  return filter;
}

/// Whether the half-size frame would hold other buffers.
bool halves_differ(const Plan& a, const Plan& b) {
  if (a.history_format != b.history_format) return true;
  if (a.half.any_cones && a.recipe.indirect_basis != b.recipe.indirect_basis) return true;
  return !std::equal(a.components.begin(), a.components.end(), b.components.begin(),
                     [](const Plan::Entry& x, const Plan::Entry& y) {
                       return x.half == y.half && (!x.half || x.cones == y.cones);
                     });
}

bool cones_differ(const Plan& a, const Plan& b, std::size_t k) {
  return a.components[k].cones != b.components[k].cones ||
         (b.components[k].cones && a.recipe.indirect_basis != b.recipe.indirect_basis);
}

/// A filter of `next` at another resolution than before, with what the old one kept.
ComponentFilter at_other_resolution(const DenoiserConfig& config, const Plan& next, std::size_t k,
                                    const Guides* last, const HalfGrid& next_quads,
                                    const PlannedParts& parts) {
  const Plan::Entry& entry = next.components[k];
  const int width = entry.half ? half_size(config.width) : config.width;
  const int height = entry.half ? half_size(config.height) : config.height;
  ComponentFilter filter(next, entry, width, height);
  if (last == nullptr) return filter;
  const ComponentHistory before = parts.filters[k].kept();
  ComponentHistory after(width, height, before.channels, before.extras);
  if (entry.half)
    halve_signal(before.data, before.data.count(), next_quads, after.data);
  else
    upsample_history(before, parts.half.last_guides(), *last, after);
  filter.keep(after);
  return filter;
}

/// What takes the place of a component's filter, or of its cones alone.
struct Replacement {
  Recipe recipe;
  std::optional<ComponentFilter> filter;
  std::optional<ConeHistory> cones;
};

}  // namespace

void switch_plan(const DenoiserConfig& config, Plan next, bool has_past,
                 const PlannedParts& parts) {
  const Plan& plan = parts.plan;
  Guides guides;
  if (has_past) guides = parts.guides.last();
  const Guides* last = has_past ? &guides : nullptr;
  const bool other_format = plan.history_format != next.history_format;
  GuidePair in_next_format;
  if (other_format)
    in_next_format =
        GuidePair(config.width, config.height, next.roughness, next.motion, next.history_format);
  const bool other_half = halves_differ(plan, next);
  HalfFrame half;
  HalfGrid quads;
  if (other_half && next.half.any) {
    half = HalfFrame(config, next);
    if (last != nullptr) quads = half.remember(*last);
  }
  SurfaceHistory surface;
  const bool needs_surface = next.history && next.full.any;
  if (needs_surface && !parts.surface.taps)
    surface = SurfaceHistory(config.width, config.height, Memory::kLent);
  std::vector<Replacement> replaced(next.components.size());
  for (std::size_t k = 0; k < replaced.size(); ++k) {
    const Plan::Entry& entry = next.components[k];
    const int width = entry.half ? half_size(config.width) : config.width;
    const int height = entry.half ? half_size(config.height) : config.height;
    replaced[k].recipe = next.recipe_of(entry);
    if (entry.half != plan.components[k].half)
      replaced[k].filter = at_other_resolution(config, next, k, last, quads, parts);
    else if (other_format)
      replaced[k].filter = in_other_format(config, next, k, last, parts);
    else if (cones_differ(plan, next, k))
      replaced[k].cones =
          entry.cones ? ConeHistory(width, height, next.recipe.indirect_basis, next.history_format)
                      : ConeHistory();
  }
  parts.scratch.grow(config.width, config.height, next, next.full, config.debug_planes);

  // Nothing has changed so far but for more scratch, and nothing below can fail.
  for (std::size_t k = 0; k < replaced.size(); ++k) {
    Replacement& other = replaced[k];
    if (other.filter)
      parts.filters[k] = std::move(*other.filter);
    else
      parts.filters[k].change(std::move(other.recipe), other.cones ? &*other.cones : nullptr);
  }
  if (other_format) {
    if (has_past) in_next_format.set_last(std::move(guides));
    parts.guides = std::move(in_next_format);
  }
  if (other_half) parts.half = std::move(half);
  if (!needs_surface || surface.taps) parts.surface = std::move(surface);
  parts.scratch.trim(next, next.full);
  parts.plan = std::move(next);
}

}  // namespace holdfast
