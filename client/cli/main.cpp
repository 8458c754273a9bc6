#include <cstdio>

#include <CLI/CLI.hpp>

#include "client/cli/command.h"
#include "core/frame/error.h"
#include "proto/one_poller.h"
#include "proto/receive_memory.h"

using namespace holdfast::cli;

int main(int argc, char** argv) {
  holdfast::wire::keep_receive_memory();
  holdfast::wire::prefer_one_poller();
  CLI::App app{"Holdfast: denoising of ray-traced frames with temporally reliable motion vectors"};
  app.require_subcommand(0, 1);  // so that an unknown one is named; none is refused below
  app.set_version_flag("--version", "holdfast 0.1.0");
  add_bench(app);
  add_check(app);
  add_compare(app);
  add_demo(app);
  add_load(app);
  add_render(app);
  add_replay(app);
  add_study(app);
  add_show(app);
  try {
    app.parse(argc, argv);
    if (app.get_subcommands().empty()) throw CLI::RequiredError("A subcommand");
    return kDone;
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kDone : kBadInput;
  } catch (const holdfast::InputError& error) {
    std::fprintf(stderr, "holdfast: %s\n", error.what());
    return kBadInput;
  } catch (const ServerUnreachable& error) {
    std::fprintf(stderr, "holdfast: %s\n", error.what());
    return kServerUnreachable;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "holdfast: %s\n", error.what());
    return kFailed;
  }
}
