#include "client/measure/compare.h"

#include <cstdio>
#include <memory>

#include <CLI/CLI.hpp>

#include "client/cli/command.h"
#include "client/cli/json_file.h"
#include "client/cli/progress.h"
#include "client/measure/comparison_text.h"
#include "client/measure/report.h"

namespace holdfast::cli {
namespace {

struct Options {
  std::string test, reference, json, html, mask = "image";
  std::vector<std::string> layers;
  bool no_flip = false, quiet = false;
};

void write_html(const Options& options, const measure::Comparison& result) {
  const auto name = std::filesystem::canonical(options.test).filename().string();
  measure::write_report(
      options.html, {{options.reference, "", options.reference, {{name, options.test, result}}}},
      {.title = "Holdfast: " + options.test + " against references"});
}

void run(const Options& options) {
  measure::CompareOptions compare;
  compare.reference = options.reference;
  compare.tests = {options.test};
  compare.layers = options.layers;
  compare.flip = !options.no_flip;
  std::unique_ptr<Progress> progress;
  compare.progress = [&](std::int64_t done, std::int64_t total) {
    if (!progress) progress = std::make_unique<Progress>("compare", total, options.quiet);
    progress->update(done);
  };
  const measure::Comparison result = measure::compare(compare).front();
  progress.reset();

  const auto region = options.mask == "effect" ? measure::Region::kEffect : measure::Region::kImage;
  if (!options.json.empty()) write_json_file(options.json, comparison_json(result, region));
  if (!options.html.empty()) write_html(options, result);
  if (!options.quiet) std::fputs(comparison_table(result, region).c_str(), stdout);
}

}  // namespace

void add_compare(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("compare", "Error of results against a sequence's references");
  command->add_option("--test", options->test, "Directory with results, frame.####.exr")
      ->required();
  command->add_option("--reference", options->reference, "Sequence with references")->required();
  command
      ->add_option("--mask", options->mask,
                   "Pixels judged: image (all but sky), or effect (where the reference changed by "
                   "more than 0.02)")
      ->check(CLI::IsMember({"image", "effect"}))
      ->capture_default_str();
  command->add_option("--layers", options->layers, "Layers judged, comma separated; all if absent")
      ->delimiter(',');
  command->add_flag("--no-flip", options->no_flip, "Leave out FLIP, which takes most of the time");
  command->add_option("--html", options->html, "Write a page with pictures, error maps and plots");
  command->add_option("--json", options->json, "Write the machine-readable result to this file");
  command->add_flag("--quiet", options->quiet, "Print nothing but errors");
  command->callback([options] { run(*options); });
}

}  // namespace holdfast::cli
