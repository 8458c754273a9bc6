#include <cstdio>
#include <memory>

#include <CLI/CLI.hpp>

#include "client/cli/command.h"
#include "client/cli/image_size.h"
#include "client/cli/json_file.h"
#include "client/cli/study.h"
#include "client/cli/study_scenes.h"
#include "client/cli/study_stability.h"
#include "client/cli/study_text.h"
#include "client/cli/study_trade.h"
#include "client/cli/study_vectors.h"
#include "client/cli/study_wire.h"
#include "client/measure/claims_text.h"
#include "client/measure/markdown.h"
#include "client/measure/trade_text.h"
#include "core/denoiser/denoiser.h"
#include "core/frame/error.h"

namespace holdfast::cli {
namespace {

struct Arguments {
  QualitySettings quality;
  StudyOptions study;
  std::string size, json, markdown, svg;
  bool with_quality = false, with_trade = false, with_vectors = false, with_stability = false,
       with_oracle = false, quick = false;
  bool with_long = false, with_large = false;
  WireStudyOptions wire;

  StabilityStudyOptions of_stability() const {
    return {study.recipes, with_long, with_large, study.quiet, json};
  }
};

/// Writes the tables to the file of --markdown, or prints them.
void write_tables(const Arguments& arguments, const std::string& tables) {
  if (!arguments.markdown.empty())
    measure::write_markdown(arguments.markdown, tables);
  else
    std::fputs(tables.c_str(), stdout);
}

void run_vectors(const Arguments& arguments) {
  VectorStudyOptions options{.out = arguments.study.out,
                             .seed = arguments.quality.seed,
                             .quick = arguments.quick,
                             .quiet = arguments.study.quiet};
  if (!arguments.size.empty())
    parse_image_size("option --size", arguments.size, options.width, options.height);
  std::vector<StudyStep> steps;
  const measure::VectorStudy study = study_vectors(options, steps);
  if (!arguments.json.empty()) {
    nlohmann::ordered_json json = measure::vector_json(study);
    for (const StudyStep& step : steps) json["seconds"][step.name] = step.seconds;
    write_json_file(arguments.json, json);
  }
  write_tables(arguments, measure::vector_markdown(study));
  if (!options.quiet) std::fputs(steps_text(steps).c_str(), stderr);
}

/// Of --stability and --oracle, which both hold errors against limits.
void run_stability(const Arguments& arguments) {
  bool passed = false;
  const auto study = arguments.with_oracle ? study_oracle : study_stability;
  write_tables(arguments, study(arguments.of_stability(), passed));
  if (!passed) throw std::runtime_error("an error is beyond its limit");
}

void run_wire(Arguments& arguments) {
  arguments.wire.quiet = arguments.study.quiet;
  const auto figures = study_wire(arguments.wire);
  if (!arguments.json.empty()) write_json_file(arguments.json, wire_json(figures));
  write_tables(arguments, wire_markdown(figures));
}

void run_quality(Arguments& arguments) {
  QualitySettings& quality = arguments.quality;
  StudyOptions& options = arguments.study;
  if (options.out.empty())
    throw InputError("option --output", "is needed with --quality", "absent");
  if (!arguments.size.empty())
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
  write_tables(arguments, quality_markdown(study.scenes, claims));
  if (!options.quiet)
    std::fprintf(stderr, "%sreport: %s\n", steps_text(study.steps).c_str(), page.c_str());
}

void run_trade(Arguments& arguments) {
  QualitySettings& quality = arguments.quality;
  StudyOptions& options = arguments.study;
  if (options.out.empty()) throw InputError("option --output", "is needed with --trade", "absent");
  if (!arguments.size.empty())
    parse_image_size("option --size", arguments.size, quality.width, quality.height);
  if (options.recipes == recipe_names())
    options.recipes = {"reliable", "spatial", "clamp", "svgf", "paper"};
  for (const std::string& scene : quality.scenes)
    options.scenes.push_back(quality_render(scene, quality));
  std::vector<StudyStep> steps;
  const auto scenes = study_trade(options, quality.frames, steps);
  const auto page = options.out / "trade.html";
  measure::write_trade_report(page, scenes);
  if (!arguments.svg.empty()) measure::write_trade_svg(arguments.svg, scenes);
  if (!arguments.json.empty()) {
    nlohmann::ordered_json json = measure::trade_json(scenes);
    for (const StudyStep& step : steps) json["seconds"][step.name] = step.seconds;
    write_json_file(arguments.json, json);
  }
  write_tables(arguments, measure::trade_markdown(scenes));
  if (!options.quiet)
    std::fprintf(stderr, "%sreport: %s\n", steps_text(steps).c_str(), page.c_str());
}

/// Options that mean nothing to other studies; recipes are nothing to one of vectors alone.
void add_quality_options(CLI::App& command, CLI::Option* with_vectors, CLI::Option* with_stability,
                         CLI::Option* with_oracle, QualitySettings& quality, StudyOptions& study) {
  command.add_option("--recipes", study.recipes, "Recipes, comma separated")
      ->delimiter(',')
      ->capture_default_str()
      ->excludes(with_vectors);
  CLI::Option* options[] = {
      command.add_option("--scenes", quality.scenes, "Scenes, comma separated")
          ->delimiter(',')
          ->capture_default_str(),
      command.add_option("--frames", quality.frames, "Frames of each scene; \"cut\" always has 80")
          ->check(CLI::Range(std::int64_t{1}, std::int64_t{1000000}))
          ->capture_default_str(),
      command
          .add_option("--reference-spp", quality.reference_spp,
                      "Samples per pixel of references; 256 to 2048, by scene, if absent")
          ->check(CLI::PositiveNumber),
      command.add_option("--speed", quality.speed, "Multiplies the speed of all animation")
          ->check(CLI::NonNegativeNumber)
          ->capture_default_str(),
      command.add_flag("--reuse", study.reuse, "Keep sequences that are in the folder already"),
      command.add_flag("!--no-flip", study.flip,
                       "Leave out FLIP, which takes most of the comparison")};
  for (CLI::Option* option : options)
    option->excludes(with_vectors)->excludes(with_stability)->excludes(with_oracle);
}

void add_stability_options(CLI::App& command, CLI::Option* with_stability, Arguments& arguments) {
  command
      .add_flag("--long", arguments.with_long,
                "Of --stability: runs of 100 000 frames at rest and 10 000 that move, too")
      ->needs(with_stability);
  command
      .add_flag("--large", arguments.with_large,
                "Of --stability: an image of 8192x4320, too, which takes 15 GB of memory")
      ->needs(with_stability);
}

}  // namespace

void add_study(CLI::App& app) {
  const auto arguments = std::make_shared<Arguments>();
  QualitySettings& quality = arguments->quality;
  StudyOptions& study = arguments->study;
  study.recipes = recipe_names();
  CLI::App& command = *app.add_subcommand("study",
                                          "Measure recipes, presets, motion vectors, stability, "
                                          "rounding or wire profiles: figures, claims, "
                                          "pictures");
  CLI::App& subject = *command.add_option_group("subject")->require_option(1);
  subject.add_flag("--quality", arguments->with_quality,
                   "All recipes on all scenes: errors, and whether the claims hold");
  CLI::Option* with_trade = subject.add_flag(
      "--trade", arguments->with_trade,
      "Speed against accuracy: presets and what they choose between, and the best of them");
  CLI::Option* with_vectors = subject.add_flag(
      "--vectors", arguments->with_vectors,
      "Motion vectors alone: the frame before without noise, warped by each of them");
  CLI::Option* with_stability = subject.add_flag(
      "--stability", arguments->with_stability,
      "The table of extremes: what is sent, what is expected, how far results are from it");
  CLI::Option* with_oracle = subject.add_flag(
      "--oracle", arguments->with_oracle,
      "How far the kernels are, stage by stage, from the same frames in double precision");
  subject
      .add_option("--wire", arguments->wire.sequences,
                  "Wire profiles on these sequences: bytes, times and errors of each")
      ->delimiter(',');
  command.add_option("-o,--output", study.out,
                     "Folder of everything that is made; of the pictures of --vectors");
  add_quality_options(command, with_vectors, with_stability, with_oracle, quality, study);
  add_stability_options(command, with_stability, *arguments);
  command.add_option("--size", arguments->size,
                     "WIDTHxHEIGHT in pixels; 480x270, or 240x135 of --vectors, if absent");
  command.add_option("--seed", quality.seed, "Seed of all random numbers")->capture_default_str();
  command
      .add_flag("--quick", arguments->quick, "Of --vectors: fewer roughnesses, frames and samples")
      ->needs(with_vectors);
  command.add_option("--svg", arguments->svg, "Of --trade: write the plot to this file")
      ->needs(with_trade);
  command.add_option("--json", arguments->json, "Write the machine-readable result to this file");
  command.add_option("--markdown", arguments->markdown,
                     "Write the tables to this file, between its lines <!-- table:begin --> and "
                     "<!-- table:end --> if it has them; else they are printed");
  command.add_flag("--quiet", study.quiet, "Print nothing but the tables and errors");
  command.callback([arguments] {
    if (arguments->with_vectors)
      run_vectors(*arguments);
    else if (arguments->with_stability || arguments->with_oracle)
      run_stability(*arguments);
    else if (arguments->with_trade)
      run_trade(*arguments);
    else if (!arguments->wire.sequences.empty())
      run_wire(*arguments);
    else
      run_quality(*arguments);
  });
}

}  // namespace holdfast::cli
