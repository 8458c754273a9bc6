#include "core/denoiser/plan.h"

#include <algorithm>
#include <set>

#include "core/denoiser/frame_input.h"
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
    for (int c = 0; c < 3; ++c)
      if (!(light.radiance[c] >= 0 && light.radiance[c] <= double{kLargestRadiance}))
        throw InputError("radiance of " + subject, "must be in 0..1e15",
                         std::to_string(light.radiance[c]));
  }
}

/// True if the frames bring a light's visibility and all that its unshadowed light follows from.
bool is_shaded_here(const DenoiserConfig& config, const Light& light) {
  return light.radiance != glm::dvec3(0) &&
         has(config, PlaneId::of_light(PlaneKind::kVisibility, light.id)) &&
         !has(config, PlaneId::of_light(PlaneKind::kUnshadowed, light.id)) &&
         has(config, {PlaneKind::kAlbedo, {}});
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

bool is_halved(const Preset& preset, ComponentKind kind) {
  switch (kind) {
    case ComponentKind::kVisibility: return preset.half_visibility;
    case ComponentKind::kGlossy: return preset.half_glossy;
    case ComponentKind::kIndirect: return preset.half_indirect;
  }
  return false;
}

/// Of the moments of the luminance their difference is used, which may be any small part of them.
HistoryFormat format_of(const Preset& preset, const Recipe& recipe) {
  return recipe.svgf_filter ? HistoryFormat::kFloat : preset.history;
}

/// Only who notices changes of light may look away, and what is looked at are floats.
int rest_turns_of(const Plan& plan) {
  const Recipe& recipe = plan.recipe;
  const bool notices = recipe.blending == Blending::kExpectedError &&
                       recipe.visibility_blend.change.noticed &&
                       recipe.glossy_blend.change.noticed && recipe.indirect_blend.change.noticed;
  const bool rests = notices && plan.history_format == HistoryFormat::kFloat &&
                     !plan.any_gradients && !plan.components.empty() && !plan.preset.oracle;
  return rests ? plan.preset.rest_turns : 1;
}

/// Deals the turns at rest so that frames cost about the same: the dearest components first, each
/// to the turn with the least so far.
void deal_turns(Plan& plan) {
  std::vector<int> cost(static_cast<std::size_t>(plan.rest_turns));
  for (const bool radiance : {true, false})
    for (Plan::Entry& entry : plan.components) {
      if ((entry.component.kind != ComponentKind::kVisibility) != radiance) continue;
      const auto least = std::min_element(cost.begin(), cost.end());
      entry.turn = static_cast<int>(least - cost.begin());
      *least += entry.half ? 1 : radiance ? 3 : 2;  // about, as measured
    }
}

}  // namespace

Plan Plan::make(const DenoiserConfig& config) {
  check_size(config);
  check_lights(config);
  check_planes(config);
  Plan plan;
  plan.recipe = find_recipe(config.recipe);
  plan.preset = find_preset(config);
  apply(plan.preset, !config.indirect_basis.empty(), plan.recipe);
  const Recipe& recipe = plan.recipe;
  plan.history = recipe.blending != Blending::kNoHistory;
  if (plan.history) plan.history_format = format_of(plan.preset, recipe);
  for (const PlaneId id : config.planes) {
    const std::uint32_t light = id.component.light;
    if (id.kind == PlaneKind::kVisibility) {
      const bool blockers = has(config, PlaneId::of_light(PlaneKind::kBlockerDistance, light)) &&
                            has(config, PlaneId::of_light(PlaneKind::kLightSample, light));
      plan.components.push_back(
          {id.component, blockers, blockers && recipe.shadow != ShadowVectors::kNone});
    } else if (id.kind == PlaneKind::kGlossy) {
      const bool hits = has(config, {PlaneKind::kGlossyDirection, {}}) &&
                        has(config, {PlaneKind::kGlossyHitDistance, {}});
      const bool follows = hits && recipe.glossy != GlossyVectors::kNone;
      plan.roughness = hits && has(config, {PlaneKind::kRoughness, {}});
      plan.components.push_back({{ComponentKind::kGlossy, 0}, plan.roughness, follows});
    } else if (id.kind == PlaneKind::kIndirect) {
      const bool follows = recipe.indirect != DisocclusionVectors::kNone;
      const bool cones = plan.history && recipe.indirect_basis != RadianceBasis::kIrradiance &&
                         has(config, {PlaneKind::kIndirectDirection, {}});
      plan.components.push_back({{ComponentKind::kIndirect, 0}, false, follows, cones});
      plan.motion = follows && has(config, {PlaneKind::kMotion, {}});
    }
  }
  for (Entry& entry : plan.components) {
    entry.gradients =
        recipe.gradient_levels > 0 && has(config, {PlaneKind::kGradient, entry.component});
    plan.any_gradients |= entry.gradients;
    entry.half = !entry.gradients && is_halved(plan.preset, entry.component.kind);
    // Whoever follows shadows meets those places; the other recipes with history stay as published.
    entry.leaves_out_unlit = entry.component.kind == ComponentKind::kVisibility &&
                             (recipe.shadow != ShadowVectors::kNone || !plan.history);
    Grid& grid = entry.half ? plan.half : plan.full;
    grid.any = true;
    grid.any_radiance |= entry.component.kind != ComponentKind::kVisibility;
    grid.any_footprint |= entry.has_footprint;
    grid.any_effect |= entry.follows_effect;
    grid.any_visibility |= entry.component.kind == ComponentKind::kVisibility;
    grid.any_cones |= entry.cones;
  }
  plan.rest_turns = rest_turns_of(plan);
  deal_turns(plan);
  for (const Light& light : config.lights)
    if (is_shaded_here(config, light)) plan.shaded_lights.push_back(light.id);
  plan.shaded_lobe =
      has(config, {PlaneKind::kSpecular, {}}) && has(config, {PlaneKind::kRoughness, {}});
  return plan;
}

HistoryExtras Plan::extras() const {
  return recipe.svgf_filter ? HistoryExtras::kMoments : HistoryExtras::kNone;
}

Recipe Plan::recipe_of(const Entry& entry) const {
  Recipe own = recipe;
  if (!entry.half) return own;
  for (int* levels : {&own.visibility_filter.levels, &own.radiance_filter.levels, &own.svgf_levels})
    *levels = std::max(*levels - 1, 1);
  return own;
}

}  // namespace holdfast
