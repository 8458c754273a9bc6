#include "core/denoiser/plan.h"

#include <algorithm>
#include <set>

#include "core/frame/error.h"

namespace holdfast {
namespace {

bool has(const DenoiserConfig& config, PlaneId id) {
  return std::find(config.planes.begin(), config.planes.end(), id) != config.planes.end();
}

void check_size(const DenoiserConfig& config) {
  const auto in_range = [](int v) { return v >= 1 && v <= kMaxDimension; };
  if (!in_range(config.width) || !in_range(config.height))
    throw InputError("frame size",
                     "must have width and height in 1.." + std::to_string(kMaxDimension),
                     std::to_string(config.width) + "x" + std::to_string(config.height));
}

void check_lights(const DenoiserConfig& config) {
  std::set<std::uint32_t> ids;
  for (const Light& light : config.lights) {
    const std::string subject = "light " + std::to_string(light.id);
    if (!ids.insert(light.id).second)
      throw InputError(subject, "must be listed once", "listed twice");
    for (const double size : {light.width, light.height, light.radius})
      if (!(size >= 0 && size <= 1e12))
        throw InputError("size of " + subject, "must be in 0..1e12 metres", std::to_string(size));
  }
}

/// A gradient plane must belong to a component among the session's planes.
void check_gradient(const DenoiserConfig& config, PlaneId id) {
  if (id.kind == PlaneKind::kGradient && !has(config, component_plane(id.component)))
    throw InputError("plane " + plane_name(id), "must belong to a component of the session",
                     "of " + component_name(id.component) + ", which is not among its planes");
}

void check_planes(const DenoiserConfig& config) {
  std::set<PlaneId> ids;
  for (const PlaneId id : config.planes) {
    const std::string subject = "plane " + plane_name(id);
    if (!ids.insert(id).second) throw InputError(subject, "must be listed once", "listed twice");
    if (id.kind > PlaneKind::kGradient)
      throw InputError(subject, "must be an input plane", "a result plane");
    check_gradient(config, id);
    const bool known = std::any_of(config.lights.begin(), config.lights.end(),
                                   [&](const Light& l) { return l.id == id.component.light; });
    if (plane_traits(id.kind).per_light && !known)
      throw InputError(subject, "must belong to a light of the session",
                       "of unknown light " + std::to_string(id.component.light));
  }
  for (const PlaneKind kind : {PlaneKind::kDepth, PlaneKind::kNormal})
    if (!ids.contains({kind, {}}))
      throw InputError("plane " + plane_name({kind, {}}), "must be among the session's planes",
                       "missing");
}

}  // namespace

Plan Plan::make(const DenoiserConfig& config) {
  check_size(config);
  check_lights(config);
  check_planes(config);
  if (const auto& names = preset_names();
      std::find(names.begin(), names.end(), config.preset) == names.end())
    throw InputError("preset", "must be " + names.front(), "'" + config.preset + "'");
  Plan plan;
  plan.recipe = find_recipe(config.recipe);
  plan.history = plan.recipe.vectors != HistoryVectors::kNone;
  for (const PlaneId id : config.planes) {
    if (id.kind == PlaneKind::kVisibility) {
      const std::uint32_t light = id.component.light;
      const bool follows = has(config, PlaneId::of_light(PlaneKind::kBlockerDistance, light)) &&
                           has(config, PlaneId::of_light(PlaneKind::kLightSample, light));
      plan.components.push_back({id.component, follows});
      plan.any_shadow |= follows;
    } else if (id.kind == PlaneKind::kGlossy || id.kind == PlaneKind::kIndirect) {
      plan.components.push_back(
          {{id.kind == PlaneKind::kGlossy ? ComponentKind::kGlossy : ComponentKind::kIndirect, 0},
           false});
      plan.any_radiance = true;
    }
  }
  for (Entry& entry : plan.components) {
    entry.gradients =
        plan.recipe.gradient_levels > 0 && has(config, {PlaneKind::kGradient, entry.component});
    plan.any_gradients |= entry.gradients;
  }
  return plan;
}

std::string Plan::text() const {
  std::string text = "recipe " + recipe.name + "\n";
  if (history) text += "frame: surface motion vectors and history taps\n";
  for (const Entry& entry : components) {
    const std::string name = component_name(entry.component);
    const bool visibility = entry.component.kind == ComponentKind::kVisibility;
    text +=
        name + ": local statistics" + (entry.follows_shadows ? ", penumbra footprint" : "") + "\n";
    if (history) {
      const bool shadow =
          entry.follows_shadows && (recipe.vectors == HistoryVectors::kPaperShadow ||
                                    recipe.vectors == HistoryVectors::kCandidates);
      text += name + ": history along " + (shadow ? "shadow and surface" : "surface") +
              " vectors, " +
              (recipe.vectors == HistoryVectors::kCandidates
                   ? "blended by expected error"
                   : (recipe.accumulation.rectification == Rectification::kNone
                          ? "exponential mean"
                          : "exponential mean, clamped")) +
              "\n";
    }
    if (recipe.gradient_levels > 0)
      text += name + (entry.gradients ? ": history replaced sooner by gradient samples\n"
                                      : ": no gradient samples, history at its fixed pace\n");
    const int levels = recipe.svgf_filter ? recipe.svgf_levels
                       : visibility       ? recipe.visibility_filter.levels
                                          : recipe.radiance_filter.levels;
    text += name + ": " + (recipe.svgf_filter ? "variance-guided" : "sample-weighted") +
            " a-trous, " + std::to_string(levels) + " levels\n";
  }
  return text + "frame: composite\n";
}

}  // namespace holdfast
