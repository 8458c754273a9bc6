#include "client/cli/study.h"

#include <nlohmann/json.hpp>

#include "client/cli/progress.h"
#include "client/cli/replay.h"
#include "client/cli/study_sequence.h"
#include "client/measure/comparison_text.h"
#include "client/measure/reference_noise.h"
#include "client/scenes/load.h"
#include "client/sequence/sequence.h"
#include "core/denoiser/recipe.h"

namespace holdfast::cli {
namespace {

double median_core_ms(const ReplayResult& result) {
  return replay_json(result)["ms"]["core"]["p50"].get<double>();
}

measure::ReportResult replay_recipe(const StudyOptions& options, const std::string& recipe,
                                    const measure::ReportScene& scene) {
  ReplayOptions replay;
  replay.dir = scene.sequence;
  replay.out = scene.sequence.parent_path() / recipe;
  replay.recipe = recipe;
  replay.quiet = options.quiet;
  const ReplayResult result = replay_sequence(replay);
  return {recipe, replay.out, {}, median_core_ms(result)};
}

void compare_recipes(const StudyOptions& options, measure::ReportScene& scene) {
  measure::CompareOptions compare;
  compare.reference = scene.sequence;
  for (const measure::ReportResult& result : scene.results) compare.tests.push_back(result.dir);
  compare.flip = options.flip;
  std::unique_ptr<Progress> progress;
  compare.progress = [&](std::int64_t done, std::int64_t total) {
    if (!progress)
      progress = std::make_unique<Progress>("compare " + scene.name, total, options.quiet);
    progress->update(done);
  };
  auto comparisons = measure::compare(compare);
  for (std::size_t i = 0; i < comparisons.size(); ++i)
    scene.results[i].comparison = std::move(comparisons[i]);
}

std::string caption_of(const RenderOptions& render) {
  const SequenceReader sequence(render.out);
  return std::to_string(sequence.frame_indices().size()) + " frames of " +
         std::to_string(sequence.header().width) + "x" + std::to_string(sequence.header().height) +
         ", one sample per pixel; references with " +
         std::to_string(render.settings.reference_spp) + " samples.";
}

void measure_references(const RenderOptions& render, measure::ReportScene& scene) {
  const std::int64_t frame = measure::last_referenced_frame(scene.sequence);
  scene.reference_noise =
      measure::reference_noise(scene.sequence, frame, second_reference(render, frame));
}

}  // namespace

std::string scene_folder(const std::string& scene) {
  return scene.ends_with(".json") ? std::filesystem::path(scene).stem().string() : scene;
}

StudyResult run_study(const StudyOptions& options) {
  for (const std::string& recipe : options.recipes) find_recipe(recipe);
  for (const RenderOptions& render : options.scenes) scenes::load_scene(render.scene);
  StudyResult study;
  for (RenderOptions render : options.scenes) {
    const std::string name = scene_folder(render.scene);
    render.out = options.out / name / "sequence";
    render.quiet = options.quiet;
    timed(study.steps, "render " + name, [&] { provide_sequence(render, options.reuse); });
    measure::ReportScene& scene =
        study.scenes.emplace_back(measure::ReportScene{name, caption_of(render), render.out, {}});
    if (options.measure_references)
      timed(study.steps, "references of " + name, [&] { measure_references(render, scene); });
    timed(study.steps, "replay " + name, [&] {
      for (const std::string& recipe : options.recipes)
        scene.results.push_back(replay_recipe(options, recipe, scene));
    });
    timed(study.steps, "compare " + name, [&] { compare_recipes(options, scene); });
  }
  return study;
}

std::string steps_text(const std::vector<StudyStep>& steps) {
  std::string line = "seconds: ";
  double sum = 0;
  for (const StudyStep& step : steps) {
    line += step.name + " " + measure::number_text(step.seconds, 1) + ", ";
    sum += step.seconds;
  }
  return line + "in all " + measure::number_text(sum, 1) + "\n";
}

}  // namespace holdfast::cli
