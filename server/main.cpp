#include <csignal>
#include <cstdio>

#include <CLI/CLI.hpp>

#include "core/frame/error.h"
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

void add_options(CLI::App& app, holdfast::server::ServerConfig& config, int& linger_ms,
                 int& drain_ms) {
  app.add_option("--listen", config.listen, "host:port (port 0 = any free one) or unix:PATH")
      ->capture_default_str();
  app.add_option("--threads", config.threads, "threads that filter; 0 = one for each core")
      ->capture_default_str()
      ->check(CLI::Range(0, 1024));
  app.add_option("--log-level", config.log_level, "trace, debug, info, warn, error or off")
      ->capture_default_str();
  app.add_option("--max-sessions", config.limits.max_sessions, "sessions that may exist at once")
      ->capture_default_str()
      ->check(CLI::Range(1, 100000));
  app.add_option("--max-session-bytes", config.limits.max_session_bytes, "memory of one session")
      ->capture_default_str();
  app.add_option("--max-total-bytes", config.limits.max_total_bytes, "memory of all sessions")
      ->capture_default_str();
  app.add_option("--credits", config.limits.credits, "frames in flight for each session")
      ->capture_default_str()
      ->check(CLI::Range(1, 16));
  app.add_option("--linger-ms", linger_ms, "how long a session is kept without a stream")
      ->capture_default_str()
      ->check(CLI::Range(0, 86400000));
  app.add_option("--drain-ms", drain_ms, "time for frames in flight when told to stop")
      ->capture_default_str()
      ->check(CLI::Range(0, 3600000));
}

}  // namespace

int main(int argc, char** argv) {
  holdfast::server::ServerConfig config;
  int linger_ms = static_cast<int>(config.limits.linger.count());
  int drain_ms = static_cast<int>(config.drain_deadline.count());
  CLI::App app{"holdfast-server: denoises ray-traced frames for clients over gRPC"};
  app.set_version_flag("--version", std::string("holdfast-server ") + holdfast::server::kVersion);
  add_options(app, config, linger_ms, drain_ms);
  try {
    app.parse(argc, argv);
    config.limits.linger = std::chrono::milliseconds(linger_ms);
    config.drain_deadline = std::chrono::milliseconds(drain_ms);
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
