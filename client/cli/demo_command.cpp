#include <cstdio>
#include <memory>

#include <CLI/CLI.hpp>

#include "client/cli/command.h"
#include "client/cli/demo.h"
#include "client/cli/image_size.h"
#include "client/cli/json_file.h"

namespace holdfast::cli {

void add_demo(CLI::App& app) {
  struct Arguments {
    DemoOptions options;
    std::string size = "480x270", json;
  };
  const auto arguments = std::make_shared<Arguments>();
  DemoOptions& options = arguments->options;
  CLI::App& command = *app.add_subcommand(
      "demo", "Render scenes, denoise them with several recipes, compare, and write a report");
  command.add_option("-o,--output", options.out, "Folder of everything that is made")->required();
  command.add_option("--scenes", options.scenes, "Scenes, comma separated")
      ->delimiter(',')
      ->capture_default_str();
  command.add_option("--recipes", options.recipes, "Recipes, comma separated")
      ->delimiter(',')
      ->capture_default_str();
  command.add_option("--frames", options.frames, "Frames of each scene")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{1000000}))
      ->capture_default_str();
  command.add_option("--size", arguments->size, "WIDTHxHEIGHT in pixels")->capture_default_str();
  command.add_option("--reference-spp", options.reference_spp, "Samples per pixel of references")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command.add_option("--seed", options.seed, "Seed of all random numbers")->capture_default_str();
  command.add_option("--speed", options.speed, "Multiplies the speed of all animation")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command.add_flag("!--no-flip", options.flip,
                   "Leave out FLIP, which takes most of the comparison");
  command.add_option("--json", arguments->json, "Write the machine-readable result to this file");
  command.add_flag("--quiet", options.quiet, "Print nothing but errors");
  command.callback([arguments] {
    DemoOptions& chosen = arguments->options;
    parse_image_size("option --size", arguments->size, chosen.width, chosen.height);
    const StudyResult result = run_demo(chosen);
    if (!arguments->json.empty()) write_json_file(arguments->json, demo_json(result));
    if (chosen.quiet) return;
    std::printf("%s%sreport: %s\n", demo_table(result.scenes).c_str(),
                steps_text(result.steps).c_str(), (chosen.out / "report.html").c_str());
  });
}

}  // namespace holdfast::cli
