#include <cstdio>
#include <memory>

#include "client/cli/command.h"
#include "client/cli/image_size.h"
#include "client/cli/json_file.h"
#include "client/cli/study.h"
#include "client/cli/study_scenes.h"
#include "client/cli/study_text.h"
#include "client/measure/claims_text.h"
#include "client/measure/markdown.h"
#include "core/denoiser/denoiser.h"

namespace holdfast::cli {
namespace {

struct Arguments {
  QualitySettings quality;
  StudyOptions study;
  std::string size = "480x270", json, markdown;
  bool with_quality = false;
};

void run(Arguments& arguments) {
  QualitySettings& quality = arguments.quality;
  StudyOptions& options = arguments.study;
  parse_image_size("option --size", arguments.size, quality.width, quality.height);
  for (const std::string& scene : quality.scenes)
    options.scenes.push_back(quality_render(scene, quality));
  options.measure_references = true;
  StudyResult study = run_study(options);
  const auto claims = measure::evaluate_claims(study.scenes);
  const auto page = options.out / "report.html";
  timed(study.steps, "report", [&] {
    measure::write_report(page, study.scenes,
                          {.title = "Holdfast: quality of the recipes",
                           .top_html = claims_html(claims),
                           .png_dir = options.out / "png",
                           .link_pictures = true});
  });
  if (!arguments.json.empty()) write_json_file(arguments.json, quality_json(study, claims));
  const std::string markdown = quality_markdown(study.scenes, claims);
  if (!arguments.markdown.empty())
    measure::write_markdown(arguments.markdown, markdown);
  else
    std::fputs(markdown.c_str(), stdout);
  if (!options.quiet)
    std::fprintf(stderr, "%sreport: %s\n", steps_text(study.steps).c_str(), page.c_str());
}

}  // namespace

void add_study(CLI::App& app) {
  const auto arguments = std::make_shared<Arguments>();
  QualitySettings& quality = arguments->quality;
  StudyOptions& study = arguments->study;
  study.recipes = recipe_names();
  CLI::App& command = *app.add_subcommand(
      "study", "Measure all recipes on all scenes: figures, claims, tables and a report");
  command
      .add_flag("--quality", arguments->with_quality,
                "Errors against references, and whether the claims hold")
      ->required();
  command.add_option("-o,--output", study.out, "Folder of everything that is made")->required();
  command.add_option("--scenes", quality.scenes, "Scenes, comma separated")
      ->delimiter(',')
      ->capture_default_str();
  command.add_option("--recipes", study.recipes, "Recipes, comma separated")
      ->delimiter(',')
      ->capture_default_str();
  command.add_option("--frames", quality.frames, "Frames of each scene; \"cut\" always has 80")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{1000000}))
      ->capture_default_str();
  command.add_option("--size", arguments->size, "WIDTHxHEIGHT in pixels")->capture_default_str();
  command
      .add_option("--reference-spp", quality.reference_spp,
                  "Samples per pixel of references; 1600 or 1024, by scene, if absent")
      ->check(CLI::PositiveNumber);
  command.add_option("--seed", quality.seed, "Seed of all random numbers")->capture_default_str();
  command.add_option("--speed", quality.speed, "Multiplies the speed of all animation")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command.add_flag("--reuse", study.reuse, "Keep sequences that are in the folder already");
  command.add_flag("!--no-flip", study.flip, "Leave out FLIP, which takes most of the comparison");
  command.add_option("--json", arguments->json, "Write the machine-readable result to this file");
  command.add_option("--markdown", arguments->markdown,
                     "Write the tables to this file, between its lines <!-- table:begin --> and "
                     "<!-- table:end --> if it has them; else they are printed");
  command.add_flag("--quiet", study.quiet, "Print nothing but the tables and errors");
  command.callback([arguments] { run(*arguments); });
}

}  // namespace holdfast::cli
