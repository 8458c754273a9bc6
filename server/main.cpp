#include <csignal>
#include <cstdio>

#include <CLI/CLI.hpp>
#include <google/protobuf/stubs/logging.h>

#include "core/frame/error.h"
#include "proto/one_poller.h"
#include "proto/receive_memory.h"
#include "server/options.h"
#include "server/server.h"
#include "server/version.h"

namespace {

enum ExitCode { kDone = 0, kFailed = 1, kBadInput = 2 };

/// SIGTERM and SIGINT, blocked in every thread made after this call and waited for in the main one.
sigset_t block_stop_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGTERM);
  sigaddset(&signals, SIGINT);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  return signals;
}

}  // namespace

int main(int argc, char** argv) {
  holdfast::wire::keep_receive_memory();
  holdfast::wire::prefer_one_poller();
  holdfast::server::ServerConfig config;
  config.calibrate = true;
  bool only_check = false;
  CLI::App app{"holdfast-server: denoises ray-traced frames for clients over gRPC"};
  app.set_version_flag("--version", std::string("holdfast-server ") + holdfast::server::kVersion);
  app.add_flag("--check-config", only_check, "check the configuration, print it, and end")
      ->configurable(false);
  holdfast::server::add_options(app, config);
  try {
    app.parse(argc, argv);
    if (only_check) {
      holdfast::server::check_config(config);
      std::printf("%s", holdfast::server::options_text(app).c_str());
      return kDone;
    }
    // A hostile client could fill the log with its complaints of messages; what matters, we log.
    google::protobuf::SetLogHandler(nullptr);
    const sigset_t signals = block_stop_signals();
    holdfast::server::Server server(config);
    int signal = 0;
    sigwait(&signals, &signal);
    server.drain(config.drain_deadline);
    return kDone;
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kDone : kBadInput;
  } catch (const holdfast::InputError& error) {
    std::fprintf(stderr, "holdfast-server: %s\n", error.what());
    return kBadInput;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "holdfast-server: %s\n", error.what());
    return kFailed;
  }
}
