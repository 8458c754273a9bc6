#include "core/denoiser/recipe.h"

#include "core/frame/error.h"

namespace holdfast {
namespace {

/// What all recipes share: the same filters and constants, so that they differ by their name's
/// part.
Recipe base(std::string name, HistoryVectors vectors) {
  Recipe recipe;
  recipe.name = std::move(name);
  recipe.vectors = vectors;
  // Sparse indirect light wants large windows and a cautious threshold (method of expected error).
  recipe.radiance_blend.window_step = 3;
  recipe.radiance_blend.noise_threshold = 2.0f;
  recipe.radiance_filter = {.levels = 4, .luminance_sigma = 4.0f};
  return recipe;
}

std::vector<Recipe> make_recipes() {
  Recipe spatial = base("spatial", HistoryVectors::kNone);
  Recipe traditional = base("traditional", HistoryVectors::kSurface);
  Recipe clamp = base("clamp", HistoryVectors::kSurface);
  clamp.accumulation.rectification = Rectification::kClamp;
  Recipe clamp_box = base("clamp-box", HistoryVectors::kSurface);
  clamp_box.accumulation.rectification = Rectification::kClampBox;
  Recipe svgf = base("svgf", HistoryVectors::kSurface);
  svgf.accumulation.alpha = 0.2f;  // SVGF sec. 4.1
  svgf.svgf_filter = true;
  Recipe asvgf = svgf;
  asvgf.name = "asvgf";
  asvgf.gradient_levels = 1;  // ours, as for paper-adaptive: best of 1..5 on fence and cylinder
  Recipe paper = base("paper", HistoryVectors::kPaperShadow);
  paper.accumulation.rectification = Rectification::kClampFallback;
  Recipe paper_adaptive = paper;
  paper_adaptive.name = "paper-adaptive";
  paper_adaptive.gradient_levels = 2;
  Recipe reliable = base("reliable", HistoryVectors::kCandidates);
  return {spatial, traditional, clamp, clamp_box, svgf, asvgf, paper, paper_adaptive, reliable};
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
