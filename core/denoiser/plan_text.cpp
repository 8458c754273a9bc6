#include "core/denoiser/plan.h"

namespace holdfast {
namespace {

const char* vectors_of(const Plan::Entry& entry) {
  if (!entry.follows_effect) return "surface";
  switch (entry.component.kind) {
    case ComponentKind::kVisibility: return "shadow and surface";
    case ComponentKind::kGlossy: return "reflection and surface";
    case ComponentKind::kIndirect: return "surface and, where it was hidden, dual";
  }
  return "";
}

const char* basis_of(RadianceBasis basis) {
  return basis == RadianceBasis::kConesColour ? "six cones of colour"
                                              : "six cones of luminance and one chroma";
}

const char* blending_of(const Recipe& recipe) {
  if (recipe.blending == Blending::kExpectedError) return "blended by expected error";
  switch (recipe.accumulation.rectification) {
    case Rectification::kNone: return "exponential mean";
    case Rectification::kClamp:
    case Rectification::kClampBox: return "exponential mean, clamped";
    case Rectification::kClampFallback: return "exponential mean, clamped where vectors fail";
  }
  return "";
}

}  // namespace

std::string Plan::text() const {
  std::string text = "recipe " + recipe.name + "\n" + "preset " + preset.name + "\n";
  if (history) text += "frame: surface motion vectors and history taps\n";
  for (const Entry& entry : components) {
    const std::string name = component_name(entry.component);
    const bool visibility = entry.component.kind == ComponentKind::kVisibility;
    if (entry.half) text += name + ": at half resolution, upsampled along depths and normals\n";
    text +=
        name + ": local statistics" +
        (entry.has_footprint ? (visibility ? ", penumbra footprint" : ", lobe footprint") : "") +
        "\n";
    if (history)
      text +=
          name + ": history along " + vectors_of(entry) + " vectors, " + blending_of(recipe) + "\n";
    if (entry.cones)
      text += name + ": incident radiance by " + basis_of(recipe.indirect_basis) + "\n";
    if (recipe.gradient_levels > 0)
      text += name + (entry.gradients ? ": history replaced sooner by gradient samples\n"
                                      : ": no gradient samples, history at its fixed pace\n");
    const Recipe own = recipe_of(entry);
    const AdaptiveFilterSettings& filter = visibility ? own.visibility_filter : own.radiance_filter;
    text += name + ": " + (own.svgf_filter ? "variance-guided" : "sample-weighted") + " a-trous, " +
            std::to_string(own.svgf_filter ? own.svgf_levels : filter.levels) + " levels of " +
            (own.svgf_filter || filter.radius == 2 ? "5x5" : "3x3") + " taps\n";
  }
  for (const std::uint32_t light : shaded_lights)
    text += "light" + std::to_string(light) + ".unshadowed: from the light's radiance, " +
            (shaded_lobe ? "diffuse and specular" : "diffuse") + "\n";
  return text + "frame: composite\n";
}

}  // namespace holdfast
