#include <charconv>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>

#include "client/cli/command.h"
#include "client/cli/progress.h"
#include "client/scenes/load.h"
#include "client/scenes/renderer.h"
#include "client/scenes/scene_json.h"
#include "client/sequence/sequence.h"
#include "core/frame/error.h"

namespace holdfast::cli {
namespace {

struct Options {
  std::string scene, size = "480x270";
  std::filesystem::path out, json, describe;
  std::int64_t frames = 24, reference_every = 1;
  scenes::RenderSettings settings;
  bool quiet = false;
};

/// Seconds of work since construction or the last call.
class Stopwatch {
 public:
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    return std::chrono::duration<double>(now - std::exchange(last_, now)).count();
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

/// Reads "480x270".
void parse_size(const std::string& text, int& width, int& height) {
  const char* const end = text.data() + text.size();
  const auto w = std::from_chars(text.data(), end, width);
  const bool has_width = w.ec == std::errc{} && w.ptr != end && *w.ptr == 'x';
  const auto h = has_width ? std::from_chars(w.ptr + 1, end, height) : w;
  if (!has_width || h.ec != std::errc{} || h.ptr != end)
    throw InputError("option --size", "must be WIDTHxHEIGHT in pixels", text);
}

void write_text(const std::filesystem::path& file, const std::string& text) {
  std::ofstream out(file);
  out << text << '\n';
  if (!out.flush()) throw std::runtime_error("cannot write " + file.string());
}

void render(Options options) {
  scenes::RenderSettings& settings = options.settings;
  const bool has_references = settings.reference_spp > 0;
  if (!has_references) settings.reference_spp = 1;
  parse_size(options.size, settings.width, settings.height);
  scenes::Renderer renderer(scenes::load_scene(options.scene), settings);
  const scenes::Scene& scene = renderer.scene();
  if (!options.describe.empty()) write_text(options.describe, scenes::scene_to_json(scene));

  SequenceWriter writer(options.out, {settings.width, settings.height, scene.frame_rate,
                                      renderer.lights(), renderer.objects()});
  Progress progress("render " + scene.name, options.frames, options.quiet);
  Stopwatch watch;
  double noisy_s = 0, reference_s = 0, write_s = 0;
  for (std::int64_t i = 0; i < options.frames; ++i) {
    const std::int64_t index = settings.first_frame + i;
    const Frame frame = renderer.frame(index);
    noisy_s += watch.lap();
    writer.write_frame(frame);
    write_s += watch.lap();
    if (has_references && i % options.reference_every == 0) {
      const PlaneSet& reference = renderer.reference(index);
      reference_s += watch.lap();
      writer.write_reference(index, reference);
      write_s += watch.lap();
    }
    progress.update(i + 1);
  }
  writer.finish();
  progress.finish();

  if (options.json.empty()) return;
  const nlohmann::ordered_json report{
      {"scene", scene.name},
      {"frames", options.frames},
      {"width", settings.width},
      {"height", settings.height},
      {"spp", settings.spp},
      {"reference_spp", has_references ? settings.reference_spp : 0},
      {"seed", settings.seed},
      {"seconds", {{"noisy", noisy_s}, {"reference", reference_s}, {"write", write_s}}}};
  write_text(options.json, report.dump(2));
}

}  // namespace

void add_render(CLI::App& app) {
  const auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("render", "Ray-trace a scene into a sequence, with converged references");
  command->add_option("scene", options->scene,
                      "Scene JSON file, or a built-in scene: " + scenes::builtin_scene_names())
      ->required();
  command->add_option("-o,--output", options->out, "Folder of the sequence")->required();
  command->add_option("--frames", options->frames, "Number of frames")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{1000000}))
      ->capture_default_str();
  command->add_option("--size", options->size, "WIDTHxHEIGHT in pixels")->capture_default_str();
  scenes::RenderSettings& settings = options->settings;
  command->add_option("--spp", settings.spp, "Samples per component and pixel of the noisy frames")
      ->capture_default_str();
  command
      ->add_option("--reference-spp", settings.reference_spp,
                   "The same for references, rounded up to a square; 0 = no references")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->add_option("--reference-every", options->reference_every,
                      "Render a reference for every K-th frame only")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_option("--seed", settings.seed, "Seed of all random numbers")->capture_default_str();
  command->add_option("--first", settings.first_frame, "Index of the first frame")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->add_option("--speed", settings.speed, "Multiplies the speed of all animation")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->add_option("--describe", options->describe, "Also write the scene as JSON to this file");
  command->add_option("--json", options->json, "Write figures of the run to this file");
  command->add_flag("--quiet", options->quiet, "No progress");
  command->callback([options] { render(*options); });
}

}  // namespace holdfast::cli
