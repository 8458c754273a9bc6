#include <cstdio>
#include <fstream>
#include <memory>

#include <CLI/CLI.hpp>

#include "client/cli/command.h"
#include "client/cli/image_size.h"
#include "client/cli/json_file.h"
#include "client/cli/load.h"

namespace holdfast::cli {
namespace {

struct Arguments {
  LoadOptions options;
  std::vector<std::string> sizes{"480x270"};
  std::string json, html;
  double search_ms = 0;
  bool quiet = false;
};

/// Writes a text file.
void write_file(const std::string& file, const std::string& text) {
  std::ofstream stream(file);
  stream << text;
  if (!stream.flush()) throw std::runtime_error("cannot write " + file);
}

/// The run that stands for the search: the fastest that held.
const LoadResult& best(const LoadSearch& search) {
  for (auto it = search.runs.rbegin(); it != search.runs.rend(); ++it)
    if (it->options.fps == search.fps) return *it;
  return search.runs.back();
}

void run(const Arguments& args) {
  nlohmann::ordered_json json;
  LoadResult result;
  if (args.search_ms > 0) {
    const LoadSearch search = search_load(args.options, args.search_ms);
    result = best(search);
    json = load_json(result);
    json["search"] = {{"p95_goal_ms", args.search_ms}, {"fps", search.fps}};
    if (!args.quiet)
      std::printf("%.1f frames/s each is the largest rate whose p95 stays within %g ms\n%s",
                  search.fps, args.search_ms, load_text(result).c_str());
  } else {
    result = run_load(args.options);
    json = load_json(result);
    if (!args.quiet) std::printf("%s", load_text(result).c_str());
  }
  if (!args.json.empty()) write_json_file(args.json, json);
  if (!args.html.empty()) write_file(args.html, load_html(result));
}

}  // namespace

void add_load(CLI::App& app) {
  const auto args = std::make_shared<Arguments>();
  LoadOptions& options = args->options;
  CLI::App& command = *app.add_subcommand("load", "measures a server under load");
  CLI::Option* const server = command.add_option(
      "--server", options.server, "host:port or unix:PATH; without it, a server in this process");
  command.add_option("--sessions", options.sessions, "clients at once")
      ->capture_default_str()
      ->check(CLI::Range(1, 10000));
  CLI::Option* const fps =
      command
          .add_option("--fps", options.fps,
                      "frames that each session sends a second, whether or not the server keeps "
                      "up; latency then counts from the planned time; default: as answers come")
          ->check(CLI::PositiveNumber);
  command.add_option("--seconds", options.seconds, "for which frames are sent")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  command
      .add_option(
          "--size", args->sizes,
          "of rendered frames, WIDTHxHEIGHT; several, by commas or by repetition, are taken "
          "in turn by the sessions")
      ->delimiter(',')
      ->capture_default_str();
  command
      .add_option("--frames", options.frames,
                  "built-in scene, scene file, or folder of a sequence; the first frames are sent "
                  "again and again")
      ->capture_default_str();
  command.add_option("--recipe", options.recipe)->capture_default_str();
  command.add_option("--preset", options.preset)->capture_default_str();
  command.add_option("--wire", options.wire, "wire profile")->capture_default_str();
  command
      .add_option("--search", args->search_ms,
                  "looks for the largest --fps whose 95th percentile of latency stays within that "
                  "many milliseconds")
      ->check(CLI::PositiveNumber)
      ->excludes(fps);
  command
      .add_flag("--tell-rate", options.tell_rate,
                "sessions tell the server --fps, which refuses those that it has no time for")
      ->needs(fps);
  command.add_flag("--latest", options.latest,
                   "as a game: frames that newer ones overtake are dropped");
  command
      .add_option("--deadline-ms", options.deadline_ms,
                  "after its arrival by which a frame's filtering should begin")
      ->check(CLI::PositiveNumber);
  command
      .add_option("--churn-s", options.churn_s,
                  "each client leaves after that many seconds and comes back with a new session")
      ->check(CLI::PositiveNumber);
  command
      .add_option("--delay-ms", options.link.delay_ms,
                  "that a link between clients and server adds each way")
      ->check(CLI::Range(0.0, 10000.0));
  command
      .add_option("--bandwidth-mbit", options.link.bandwidth_mbit,
                  "that the link carries for each client and direction, million bits a second")
      ->check(CLI::PositiveNumber);
  command.add_option("--threads", options.threads, "of the server in this process")
      ->check(CLI::Range(1, 1024))
      ->excludes(server);
  add_access_options(command, server, options.access);
  command.add_flag("--quiet", args->quiet, "no summary");
  command.add_option("--json", args->json, "file for the machine-readable result");
  command.add_option("--html", args->html, "file for a page with plots");
  command.callback([args] {
    args->options.sizes.clear();
    for (const std::string& size : args->sizes) {
      LoadSize& out = args->options.sizes.emplace_back();
      parse_image_size("--size", size, out.width, out.height);
    }
    run(*args);
  });
}

}  // namespace holdfast::cli
