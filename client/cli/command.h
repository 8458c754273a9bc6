#pragma once

#include <stdexcept>

namespace CLI {
class App;
}

namespace holdfast::cli {

/// Exit codes of every subcommand.
enum ExitCode { kDone = 0, kFailed = 1, kBadInput = 2, kServerUnreachable = 3 };

/// The server cannot be reached or refuses; ends the program with kServerUnreachable.
struct ServerUnreachable : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// Each adds one subcommand with its options and its work. The work throws: InputError (and
// CLI11's own errors) end with kBadInput, ServerUnreachable with kServerUnreachable, any other
// exception with kFailed.
void add_bench(CLI::App& app);
void add_check(CLI::App& app);
void add_compare(CLI::App& app);
void add_demo(CLI::App& app);
void add_load(CLI::App& app);
void add_render(CLI::App& app);
void add_replay(CLI::App& app);
void add_study(CLI::App& app);
void add_show(CLI::App& app);

}  // namespace holdfast::cli
