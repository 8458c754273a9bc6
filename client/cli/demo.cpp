#include "client/cli/demo.h"

#include <algorithm>
#include <chrono>

#include "client/cli/progress.h"
#include "client/cli/render.h"
#include "client/cli/replay.h"
#include "client/measure/strip.h"
#include "core/denoiser/denoiser.h"

namespace holdfast::cli {
namespace {

void render_scene(const DemoOptions& options, const std::string& scene,
                  const std::filesystem::path& dir) {
  RenderOptions render;
  render.scene = scene;
  render.out = dir;
  render.frames = options.frames;
  render.settings.width = options.width;
  render.settings.height = options.height;
  render.settings.reference_spp = options.reference_spp;
  render.settings.seed = options.seed;
  render.settings.speed = options.speed;
  render.settings.gradients = std::any_of(
      options.recipes.begin(), options.recipes.end(),
      [](const std::string& recipe) { return recipe_uses(recipe, PlaneKind::kGradient); });
  render.quiet = options.quiet;
  render_sequence(render);
}

void replay_recipe(const DemoOptions& options, const std::string& recipe,
                   const std::filesystem::path& sequence, const std::filesystem::path& out) {
  ReplayOptions replay;
  replay.dir = sequence;
  replay.out = out;
  replay.recipe = recipe;
  replay.quiet = options.quiet;
  replay_sequence(replay);
}

std::vector<measure::Comparison> compare_recipes(const DemoOptions& options,
                                                 const measure::ReportScene& scene) {
  measure::CompareOptions compare;
  compare.reference = scene.sequence;
  for (const measure::ReportResult& result : scene.results) compare.tests.push_back(result.dir);
  compare.flip = options.flip;
  Progress progress("compare " + scene.name, options.frames, options.quiet);
  compare.progress = [&](std::int64_t done, std::int64_t) { progress.update(done); };
  return measure::compare(compare);
}

std::string caption_of(const DemoOptions& options) {
  return std::to_string(options.frames) + " frames of " + std::to_string(options.width) + "x" +
         std::to_string(options.height) + ", one sample per pixel; references with " +
         std::to_string(options.reference_spp) + " samples.";
}

}  // namespace

DemoResult run_demo(const DemoOptions& options) {
  DemoResult demo;
  const auto timed = [&](const std::string& name, auto&& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    demo.steps.push_back({name, took.count()});
  };
  for (const std::string& name : options.scenes) {
    const std::filesystem::path dir = options.out / name;
    measure::ReportScene& scene = demo.scenes.emplace_back(
        measure::ReportScene{name, caption_of(options), dir / "sequence", {}});
    timed("render " + name, [&] { render_scene(options, name, scene.sequence); });
    timed("replay " + name, [&] {
      for (const std::string& recipe : options.recipes) {
        replay_recipe(options, recipe, scene.sequence, dir / recipe);
        scene.results.push_back({recipe, dir / recipe, {}});
      }
    });
    timed("compare " + name, [&] {
      auto comparisons = compare_recipes(options, scene);
      for (std::size_t i = 0; i < comparisons.size(); ++i)
        scene.results[i].comparison = std::move(comparisons[i]);
    });
  }
  timed("report", [&] {
    measure::write_report(options.out / "report.html",
                          "Holdfast: recipes on moving lights and shadows", demo.scenes,
                          options.out / "png");
    measure::write_png(options.out / "demo.png",
                       measure::strip_of(demo.scenes.front(), {"svgf", "reliable"}));
  });
  return demo;
}

}  // namespace holdfast::cli
