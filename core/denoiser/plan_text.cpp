#include "core/denoiser/plan.h"
#include "core/denoiser/rest.h"
#include "core/denoiser/traffic.h"

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

std::string filter_text(const Recipe& recipe, bool visibility) {
  const AdaptiveFilterSettings& filter =
      visibility ? recipe.visibility_filter : recipe.radiance_filter;
  const int levels = recipe.svgf_filter ? recipe.svgf_levels : filter.levels;
  return std::string(recipe.svgf_filter ? "variance-guided" : "sample-weighted") + " a-trous, " +
         std::to_string(levels) + " levels of " +
         std::to_string(recipe.svgf_filter ? 25 : filter.taps) + " taps";
}

/// The passes of one component, with the bytes that each moves for a pixel of the frame.
std::string text_of(const Plan& plan, const Plan::Entry& entry) {
  const Recipe recipe = plan.recipe_of(entry);
  const bool visibility = entry.component.kind == ComponentKind::kVisibility;
  const int channels = visibility ? 1 : 3;
  const std::string name = component_name(entry.component) + ": ";
  std::string text;
  const auto add = [&](const std::string& pass, int channels_moved) {
    text +=
        name + pass + ", " + std::to_string(channels_moved * (entry.half ? 1 : 4)) + " B/pixel\n";
  };
  if (entry.half) text += name + "at half resolution, upsampled along planes, normals and ids\n";
  if (entry.cones)
    add("incident radiance by " + std::string(basis_of(recipe.indirect_basis)),
        cones_traffic(recipe));
  add(std::string("local statistics") +
          (entry.has_footprint ? (visibility ? ", penumbra footprint" : ", lobe footprint") : ""),
      statistics_traffic(channels, entry.has_footprint));
  if (plan.history)
    add(std::string("history along ") + vectors_of(entry) + " vectors, " + blending_of(recipe),
        (entry.follows_effect ? vectors_traffic() : 0) +
            blend_traffic(channels, recipe.blending == Blending::kExpectedError,
                          entry.follows_effect));
  if (plan.history_format == HistoryFormat::kPacked)
    add("history unpacked, and packed again",
        2 * packing_traffic(ComponentHistory::channel_count(channels, plan.extras())));
  if (recipe.gradient_levels > 0)
    text += name + (entry.gradients ? "history replaced sooner by gradient samples\n"
                                    : "no gradient samples, history at its fixed pace\n");
  add(filter_text(recipe, visibility), filter_traffic(channels, recipe, entry.has_footprint));
  if (plan.rest_turns > 1)
    text += name + "at rest, turn " + std::to_string(entry.turn + 1) +
            "; else its light is looked at and its last result returned, " +
            std::to_string(4 * RestTurns::traffic(channels)) + " B/pixel\n";
  return text;
}

}  // namespace

std::string Plan::text() const {
  std::string text = "recipe " + recipe.name + "\n" + "preset " + preset.name + "\n";
  if (history) text += "frame: surface motion vectors and history taps\n";
  if (history)
    text += std::string("frame: what is kept for the next frame, as ") +
            history_name(history_format) + "\n";
  if (rest_turns > 1)
    text += "frame: at rest components take turns, each is filtered in one frame of " +
            std::to_string(rest_turns) + "\n";
  for (const Entry& entry : components) text += text_of(*this, entry);
  for (const std::uint32_t light : shaded_lights)
    text += "light" + std::to_string(light) + ".unshadowed: from the light's radiance, " +
            (shaded_lobe ? "diffuse and specular" : "diffuse") + "\n";
  return text + "frame: composite\n";
}

}  // namespace holdfast
