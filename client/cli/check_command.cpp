#include <cstdio>
#include <memory>

#include <CLI/CLI.hpp>

#include "client/check/check.h"
#include "client/cli/command.h"
#include "client/cli/json_file.h"
#include "client/cli/progress.h"
#include "client/sequence/sequence.h"
#include "core/frame/error.h"

namespace holdfast::cli {
namespace {

struct Options {
  std::string dir, json;
  bool quiet = false;
};

/// Throws InputError where something is wrong, so that the program ends with kBadInput.
void run(const Options& options) {
  const SequenceReader sequence(options.dir);
  const std::vector<std::int64_t> indices = sequence.frame_indices();
  Progress progress("check", static_cast<std::int64_t>(indices.size()), options.quiet);
  const check::Report report =
      check::check_frames({indices.size(), sequence.header().lights, [&](std::size_t i) {
                             Frame frame = sequence.read_frame(indices[i]);
                             progress.update(static_cast<std::int64_t>(i) + 1);
                             return frame;
                           }});
  progress.finish();
  if (!options.json.empty()) write_json_file(options.json, report_json(report));
  if (!options.quiet) std::fputs(report_text(report).c_str(), stdout);
  if (report.findings.empty()) return;
  const check::Finding& finding = report.findings.front();
  throw InputError(options.dir + ": " + finding.thing, finding.rule, "not: " + finding.evidence);
}

}  // namespace

void add_check(CLI::App& app) {
  const auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand(
      "check", "Looks for mistakes in a sequence's inputs: matrices, depth, motion, normals, ...");
  command->add_option("DIR", options->dir, "sequence: sequence.json and frame.####.exr")
      ->required();
  command->add_option("--json", options->json, "Write the machine-readable result to this file");
  command->add_flag("--quiet", options->quiet, "Print nothing but the first mistake");
  command->callback([options] { run(*options); });
}

}  // namespace holdfast::cli
