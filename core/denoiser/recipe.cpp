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
  recipe.glossy_blend.threshold = 0.7f;
  recipe.indirect_blend.effect_substitutes = true;
  recipe.radiance_filter = {.levels = 4, .luminance_sigma = 4.0f};
  return recipe;
}

Recipe make_reliable() {
  Recipe reliable = base("reliable", Blending::kExpectedError);
  reliable.shadow = ShadowVectors::kBorrowed;
  reliable.glossy = GlossyVectors::kRelative;
  reliable.indirect = DisocclusionVectors::kDual;
  reliable.indirect_basis = RadianceBasis::kConesLuminance;
  reliable.visibility_blend.change.noticed = reliable.glossy_blend.change.noticed =
      reliable.indirect_blend.change.noticed = true;
  // Indirect light changes everywhere or nowhere, and too little to show in one tile.
  reliable.indirect_blend.change.frame_share = 0.02f;
  reliable.indirect_blend.change.moving_deviations = 3.0f;
  return reliable;
}

std::vector<Recipe> make_ablated() {
  std::vector<Recipe> recipes;
  const auto without = [&](const char* part) -> Recipe& {
    Recipe& recipe = recipes.emplace_back(make_reliable());
    recipe.name += std::string("-without-") + part;
    return recipe;
  };
  without("shadow-vectors").shadow = ShadowVectors::kNone;
  without("reflection-vectors").glossy = GlossyVectors::kNone;
  without("dual-vectors").indirect = DisocclusionVectors::kNone;
  without("cones").indirect_basis = RadianceBasis::kIrradiance;
  Recipe& rest = without("trust-at-rest");
  for (RadianceBlendRule* rule : {&rest.glossy_blend, &rest.indirect_blend}) {
    rule->rest_threshold = rule->threshold;
  }
  rest.visibility_blend.rest_threshold = rest.visibility_blend.slow_threshold = 0.0f;
  Recipe& unnoticed = without("light-changes");
  unnoticed.visibility_blend.change.noticed = unnoticed.glossy_blend.change.noticed =
      unnoticed.indirect_blend.change.noticed = false;
  // Bias then counts as noise does: the plain expected error.
  Recipe& weighing = without("weight-of-bias");
  weighing.visibility_blend.spatial_samples = weighing.glossy_blend.spatial_samples =
      weighing.indirect_blend.spatial_samples = 1.0f;
  return recipes;
}

std::vector<Recipe> make_recipes() {
  const Recipe spatial = base("spatial", Blending::kNoHistory);
  const Recipe traditional = base("traditional");
  Recipe clamp = base("clamp");
  clamp.accumulation.rectification = Rectification::kClamp;
  Recipe clamp_box = base("clamp-box");
  clamp_box.accumulation.rectification = Rectification::kClampBox;
  Recipe specular = base("specular");
  specular.glossy = GlossyVectors::kSpecular;
  Recipe specular_clamp = specular;
  specular_clamp.name = "specular-clamp";
  specular_clamp.accumulation.rectification = Rectification::kClamp;
  Recipe svgf = base("svgf");
  svgf.accumulation.alpha = 0.2f;  // SVGF sec. 4.1
  svgf.svgf_filter = true;
  Recipe asvgf = svgf;
  asvgf.name = "asvgf";
  asvgf.gradient_levels = 1;  // ours, as for paper-adaptive: best of 1..5 on fence and cylinder
  Recipe paper = base("paper");
  paper.shadow = ShadowVectors::kPaper;
  paper.glossy = GlossyVectors::kStochastic;
  paper.indirect = DisocclusionVectors::kDual;
  paper.indirect_basis = RadianceBasis::kConesLuminance;
  paper.accumulation.rectification = Rectification::kClampFallback;
  Recipe paper_adaptive = paper;
  paper_adaptive.name = "paper-adaptive";
  paper_adaptive.gradient_levels = 2;
  const Recipe reliable = make_reliable();
  return {spatial, traditional, clamp, clamp_box,      specular, specular_clamp,
          svgf,    asvgf,       paper, paper_adaptive, reliable};
}

}  // namespace

const std::vector<Recipe>& all_recipes() {
  static const std::vector<Recipe> recipes = make_recipes();
  return recipes;
}

const std::vector<Recipe>& ablated_recipes() {
  static const std::vector<Recipe> recipes = make_ablated();
  return recipes;
}

const Recipe& find_recipe(std::string_view name) {
  for (const Recipe& recipe : ablated_recipes())
    if (recipe.name == name) return recipe;
  std::string names;
  for (const Recipe& recipe : all_recipes()) {
    if (recipe.name == name) return recipe;
    names.append(names.empty() ? "" : ", ").append(recipe.name);
  }
  throw InputError("recipe", "must be one of " + names, "'" + std::string(name) + "'");
}

}  // namespace holdfast
