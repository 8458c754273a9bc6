#include <cstdio>
#include <memory>

#include <CLI/CLI.hpp>

#include "client/cli/bench.h"
#include "client/cli/bench_transport.h"
#include "client/cli/command.h"
#include "client/cli/image_size.h"
#include "client/cli/json_file.h"
#include "client/cli/preset_options.h"
#include "client/scenes/load.h"

namespace holdfast::cli {
namespace {

void bench_transport(TransportOptions options, const std::string& size, const std::string& json,
                     bool quiet) {
  if (!size.empty()) parse_image_size("option --size", size, options.width, options.height);
  const TransportResult result = run_transport_bench(options);
  if (!json.empty()) write_json_file(json, transport_json(result));
  if (!quiet) std::fputs(transport_text(result).c_str(), stdout);
}

}  // namespace

void add_bench(CLI::App& app) {
  struct Arguments {
    BenchOptions options;
    TransportOptions transport_options;
    std::string size, json;
    bool plan = false, quiet = false, no_reference = false, transport = false;
  };
  const auto args = std::make_shared<Arguments>();
  BenchOptions& options = args->options;
  CLI::App& command =
      *app.add_subcommand("bench", "Time the core, stage by stage, or the transport");
  command
      .add_option("--scene", options.scene,
                  "Folder of a sequence, scene JSON file, or a built-in scene: " +
                      scenes::builtin_scene_names())
      ->capture_default_str();
  command.add_option("--size", args->size,
                     "WIDTHxHEIGHT in pixels; a sequence has its own. Default: 1920x1080, of the "
                     "transport 1920x546, which is 32 MiB up");
  command
      .add_option("--recipes", options.recipes,
                  "Recipes, with commas between; stages are the first one's. Default: reliable")
      ->delimiter(',');
  add_preset_options(command, options.preset, options.indirect_basis, options.half_resolution,
                     options.history);
  command
      .add_option("--signals", options.signals,
                  "Kinds of components to keep, with commas between: visibility, glossy, indirect")
      ->delimiter(',');
  command.add_option("--frames", options.frames, "Timed frames of each recipe")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  command
      .add_option("--warm-frames", options.warm_frames,
                  "Frames before those; after 200, components of a scene at rest take turns")
      ->check(CLI::Range(2, 100000))
      ->capture_default_str();
  command
      .add_option("--rest-turns", options.rest_turns,
                  "At rest, components are filtered once in so many frames; 1: in all. Default: "
                  "the preset's")
      ->check(CLI::Range(1, 16));
  command.add_option("--threads", options.threads, "That filter; default: one for each core")
      ->check(CLI::Range(1, 1024));
  command.add_flag("--no-reference", args->no_reference, "Do not time the scalar kernels");
  command.add_flag("--one-signal", options.one_signal,
                   "Also time one signal of three channels under svgf with four levels");
  command.add_flag("--limits", options.limits,
                   "Also measure what one thread can multiply and copy at most");
  command.add_flag("--plan", args->plan, "Also print the first recipe's plan");
  command.add_flag("--transport", args->transport,
                   "Instead, move frames through a server over TCP and a unix socket, without "
                   "filtering, against plain sockets");
  command
      .add_option("--rounds", args->transport_options.rounds,
                  "Of the transport, --frames frames each")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command
      .add_option("--delay-ms", args->transport_options.delay_ms,
                  "Measure the transport also over a link with that delay in each direction")
      ->check(CLI::Range(0.0, 1000.0));
  command.add_option("--wire", args->transport_options.wire, "Wire profile of the transport")
      ->capture_default_str();
  command.add_flag("--quiet", args->quiet, "No table");
  command.add_option("--json", args->json, "File for the machine-readable result");
  command.callback([args, &command] {
    if (args->transport) {
      if (command.count("--frames") > 0) args->transport_options.frames = args->options.frames;
      bench_transport(args->transport_options, args->size, args->json, args->quiet);
      return;
    }
    if (!args->size.empty())
      parse_image_size("option --size", args->size, args->options.width, args->options.height);
    args->options.reference = !args->no_reference;
    const BenchResult result = run_bench(args->options);
    if (!args->json.empty()) write_json_file(args->json, bench_json(result));
    if (args->plan) std::fputs(result.plan.c_str(), stdout);
    if (!args->quiet) std::fputs(bench_text(result).c_str(), stdout);
  });
}

}  // namespace holdfast::cli
