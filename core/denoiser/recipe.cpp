#include "core/denoiser/recipe.h"

#include "core/frame/error.h"

namespace holdfast {
namespace {

/// What all recipes share: the same filters and constants, so that they differ by their name's
/// part.
Recipe base(std::string name, Blending blending = Blending::kExponential) {
  Recipe recipe;
  recipe.name = std::move(name);
  recipe.blending = blending;
  // Reflections slide without a sign in their surface: the slightest difference counts.
  recipe.glossy_blend.sudden_threshold = 1.0f;
  recipe.radiance_filter = {.levels = 4, .luminance_sigma = 4.0f};
  return recipe;
}

std::vector<Recipe> make_recipes() {
  const Recipe spatial = base("spatial", Blending::kNoHistory);
  const Recipe traditional = base("traditional");
  Recipe clamp = base("clamp");
  clamp.accumulation.rectification = Rectification::kClamp;
  Recipe specular = base("specular");
  specular.glossy = GlossyVectors::kSpecular;
  Recipe specular_clamp = specular;
  specular_clamp.name = "specular-clamp";
  specular_clamp.accumulation.rectification = Rectification::kClamp;
  Recipe svgf = base("svgf");
  svgf.accumulation.alpha = 0.2f;  // SVGF sec. 4.1
  svgf.svgf_filter = true;
  Recipe paper = base("paper");
  paper.shadow = ShadowVectors::kPaper;
  paper.glossy = GlossyVectors::kStochastic;
  paper.indirect = DisocclusionVectors::kDual;
  paper.accumulation.rectification = Rectification::kClampFallback;
  Recipe reliable = base("reliable", Blending::kExpectedError);
  reliable.shadow = ShadowVectors::kBorrowed;
  reliable.glossy = GlossyVectors::kRelative;
  reliable.indirect = DisocclusionVectors::kDual;
  Recipe xr = base("xrel");
  xr.glossy = GlossyVectors::kRelative;
  xr.indirect = DisocclusionVectors::kDual;
  return {spatial, traditional, clamp, specular, specular_clamp, svgf, paper, reliable, xr};
}

}  // namespace

const std::vector<Recipe>& all_recipes() {
  static const std::vector<Recipe> recipes = make_recipes();
  return recipes;
}

const Recipe& find_recipe(std::string_view name) {
  std::string names;
  for (const Recipe& recipe : all_recipes()) {
    if (recipe.name == name) return recipe;
    names.append(names.empty() ? "" : ", ").append(recipe.name);
  }
  throw InputError("recipe", "must be one of " + names, "'" + std::string(name) + "'");
}

}  // namespace holdfast
