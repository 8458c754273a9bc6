#include <memory>

#include <CLI/CLI.hpp>

#include "client/cli/command.h"
#include "client/cli/image_size.h"
#include "client/cli/json_file.h"
#include "client/cli/render.h"
#include "client/scenes/load.h"

namespace holdfast::cli {
namespace {

struct Arguments {
  RenderOptions options;
  std::string size = "480x270", json;
};

nlohmann::ordered_json render_json(const RenderOptions& options, const RenderResult& result) {
  const scenes::RenderSettings& settings = options.settings;
  return {
      {"scene", result.scene},
      {"frames", options.frames},
      {"width", settings.width},
      {"height", settings.height},
      {"spp", settings.spp},
      {"reference_spp", settings.reference_spp},
      {"seed", settings.seed},
      {"seconds",
       {{"noisy", result.noisy_s}, {"reference", result.reference_s}, {"write", result.write_s}}}};
}

}  // namespace

void add_render(CLI::App& app) {
  const auto arguments = std::make_shared<Arguments>();
  RenderOptions& options = arguments->options;
  CLI::App* command =
      app.add_subcommand("render", "Ray-trace a scene into a sequence, with converged references");
  command
      ->add_option("scene", options.scene,
                   "Scene JSON file, or a built-in scene: " + scenes::builtin_scene_names())
      ->required();
  command->add_option("-o,--output", options.out, "Folder of the sequence")->required();
  command->add_option("--frames", options.frames, "Number of frames")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{1000000}))
      ->capture_default_str();
  command->add_option("--size", arguments->size, "WIDTHxHEIGHT in pixels")->capture_default_str();
  scenes::RenderSettings& settings = options.settings;
  command->add_option("--spp", settings.spp, "Samples per component and pixel of the noisy frames")
      ->capture_default_str();
  command
      ->add_option("--reference-spp", settings.reference_spp,
                   "The same for references, best a power of 4; 0 = no references")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command
      ->add_option("--reference-every", options.reference_every,
                   "Render a reference for every K-th frame only")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_flag("--reference-pairs", options.reference_pairs,
                    "References for the last two of every K frames instead: change from frame to "
                    "frame can be judged at a fraction of the cost");
  command->add_option("--seed", settings.seed, "Seed of all random numbers")->capture_default_str();
  command->add_option("--first", settings.first_frame, "Index of the first frame")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->add_option("--speed", settings.speed, "Multiplies the speed of all animation")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->add_flag("!--no-gradients", settings.gradients,
                    "Leave out gradient.####.exr, which the adaptive recipes use");
  command->add_option("--describe", options.describe, "Also write the scene as JSON to this file");
  command->add_option("--json", arguments->json, "Write figures of the run to this file");
  command->add_flag("--quiet", options.quiet, "No progress");
  command->callback([arguments] {
    parse_image_size("option --size", arguments->size, arguments->options.settings.width,
                     arguments->options.settings.height);
    const RenderResult result = render_sequence(arguments->options);
    if (!arguments->json.empty())
      write_json_file(arguments->json, render_json(arguments->options, result));
  });
}

}  // namespace holdfast::cli
