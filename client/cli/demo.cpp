#include "client/cli/demo.h"

#include <algorithm>

#include "client/measure/strip.h"
#include "core/denoiser/denoiser.h"

namespace holdfast::cli {
namespace {

RenderOptions render_options(const DemoOptions& options, const std::string& scene) {
  RenderOptions render;
  render.scene = scene;
  render.frames = options.frames;
  render.settings.width = options.width;
  render.settings.height = options.height;
  render.settings.reference_spp = options.reference_spp;
  render.settings.seed = options.seed;
  render.settings.speed = options.speed;
  render.settings.gradients = std::any_of(
      options.recipes.begin(), options.recipes.end(),
      [](const std::string& recipe) { return recipe_uses(recipe, PlaneKind::kGradient); });
  return render;
}

}  // namespace

StudyResult run_demo(const DemoOptions& options) {
  StudyOptions study;
  study.out = options.out;
  for (const std::string& scene : options.scenes)
    study.scenes.push_back(render_options(options, scene));
  study.recipes = options.recipes;
  study.flip = options.flip;
  study.quiet = options.quiet;
  StudyResult demo = run_study(study);
  timed(demo.steps, "report", [&] {
    measure::write_report(options.out / "report.html", demo.scenes,
                          {.title = "Holdfast: recipes on moving lights and shadows",
                           .png_dir = options.out / "png"});
    measure::write_png(options.out / "demo.png",
                       measure::strip_of(demo.scenes.front(), {"svgf", "reliable"}));
  });
  return demo;
}

}  // namespace holdfast::cli
