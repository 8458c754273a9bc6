// What a session can choose: recipes, presets, and the planes that come back.

#include <algorithm>

#include "core/denoiser/denoiser.h"
#include "core/denoiser/preset.h"
#include "core/denoiser/recipe.h"

namespace holdfast {
namespace {

template <class Named>
std::vector<std::string> names_of(const std::vector<Named>& all) {
  std::vector<std::string> names;
  for (const Named& one : all) names.push_back(one.name);
  return names;
}

}  // namespace

const std::vector<std::string>& recipe_names() {
  static const std::vector<std::string> names = names_of(all_recipes());
  return names;
}

const std::vector<std::string>& ablation_names() {
  static const std::vector<std::string> names = names_of(ablated_recipes());
  return names;
}

bool recipe_uses(std::string_view recipe, PlaneKind kind) {
  if (kind != PlaneKind::kGradient) return true;
  return std::any_of(all_recipes().begin(), all_recipes().end(),
                     [&](const Recipe& r) { return r.name == recipe && r.gradient_levels > 0; });
}

const std::vector<std::string>& preset_names() {
  static const std::vector<std::string> names = names_of(all_presets());
  return names;
}

const std::vector<std::string>& kernel_preset_names() {
  static const std::vector<std::string> names = [] {
    std::vector<Preset> presets = all_presets();
    std::erase_if(presets, [](const Preset& preset) { return preset.oracle; });
    return names_of(presets);
  }();
  return names;
}

std::vector<PlaneId> result_planes(const DenoiserConfig& config) {
  std::vector<PlaneId> out{{PlaneKind::kComposite, {}}};
  for (const PlaneId id : config.planes) {
    if (id.kind != PlaneKind::kVisibility && id.kind != PlaneKind::kGlossy &&
        id.kind != PlaneKind::kIndirect)
      continue;
    out.push_back(id);
    if (!config.debug_planes) continue;
    const Component component = id.kind == PlaneKind::kVisibility ? id.component
                                : id.kind == PlaneKind::kGlossy
                                    ? Component{ComponentKind::kGlossy, 0}
                                    : Component{ComponentKind::kIndirect, 0};
    for (const PlaneKind kind :
         {PlaneKind::kDebugMotion, PlaneKind::kDebugHistory, PlaneKind::kDebugConfidence})
      out.push_back({kind, component});
  }
  return out;
}

}  // namespace holdfast
