#include <cstdio>
#include <memory>

#include <CLI/CLI.hpp>

#include "client/cli/command.h"
#include "client/cli/frame_range.h"
#include "client/cli/json_file.h"
#include "client/cli/preset_options.h"
#include "client/cli/replay.h"

namespace holdfast::cli {
namespace {

void print(const ReplayResult& result, const ReplayOptions& options) {
  const auto json = replay_json(result);
  std::printf("%lld frames of %dx%d through %s (%s) to %s: core %.1f ms, total %.1f ms (medians)\n",
              static_cast<long long>(result.frames), result.width, result.height,
              result.recipe.c_str(), result.preset.c_str(), options.out.c_str(),
              json["ms"]["core"]["p50"].get<double>(), json["ms"]["total"]["p50"].get<double>());
}

}  // namespace

void add_replay(CLI::App& app) {
  struct Arguments {
    ReplayOptions options;
    std::string frames, json;
  };
  const auto args = std::make_shared<Arguments>();
  ReplayOptions& options = args->options;
  CLI::App& command = *app.add_subcommand(
      "replay", "streams a sequence through a server and writes the clean frames");
  command.add_option("DIR", options.dir, "sequence: sequence.json and frame.####.exr")->required();
  command.add_option("-o,--output", options.out, "directory of the results")->required();
  CLI::Option* const server = command.add_option(
      "--server", options.server, "host:port or unix:PATH; without it, a server in this process");
  command.add_option("--recipe", options.recipe)->capture_default_str();
  add_preset_options(command, options.preset, options.indirect_basis, options.half_resolution,
                     options.history);
  command.add_option("--budget-ms", options.budget_ms, "time that a frame may take in the core")
      ->check(CLI::PositiveNumber);
  command.add_option("--layers", options.layers, "result planes to write, with commas between")
      ->delimiter(',');
  command.add_option("--frames", args->frames, "frame indices A-B, both included");
  command.add_option("--fps", options.fps, "frames submitted a second; default: no wait")
      ->check(CLI::PositiveNumber);
  command.add_option("--wire", options.wire, "wire profile")->capture_default_str();
  command.add_option("--threads", options.threads, "of the server in this process")
      ->check(CLI::Range(1, 1024))
      ->excludes(server);
  add_access_options(command, server, options.access);
  command
      .add_option("--reconnect-ms", options.reconnect_ms, "how long a lost server is waited for")
      ->capture_default_str()
      ->check(CLI::Range(0, 86400000));
  command.add_flag("--debug", options.debug, "also motion, history and confidence");
  command.add_flag("--quiet", options.quiet, "no progress, no summary");
  command.add_option("--json", args->json, "file for the machine-readable result");
  command.callback([args] {
    const FrameRange range = frame_range(args->frames);
    args->options.first = range.first;
    args->options.last = range.last;
    const ReplayResult result = replay_sequence(args->options);
    if (!args->json.empty()) write_json_file(args->json, replay_json(result));
    if (!args->options.quiet) print(result, args->options);
  });
}

}  // namespace holdfast::cli
