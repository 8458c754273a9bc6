#include "server/options.h"

#include <algorithm>
#include <cctype>

namespace holdfast::server {
namespace {

constexpr int kDayMs = 86400000;

/// HOLDFAST_MAX_SESSIONS for --max-sessions.
std::string environment_name(std::string flag) {
  std::string name = "HOLDFAST_" + flag.substr(2);
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) {
    return c == '-' ? '_' : static_cast<char>(std::toupper(c));
  });
  return name;
}

/// Adds knobs to a program.
class Knobs {
 public:
  explicit Knobs(CLI::App& app) : app_(app) {}

  template <class T>
  CLI::Option* value(const std::string& flag, T& target, const std::string& help) {
    return app_.add_option(flag, target, help)
        ->capture_default_str()
        ->envname(environment_name(flag));
  }
  void milliseconds(const std::string& flag, std::chrono::milliseconds& target,
                    const std::string& help) {
    app_.add_option_function<int>(
            flag, [&target](int ms) { target = std::chrono::milliseconds(ms); }, help)
        ->default_str(std::to_string(target.count()))
        ->check(CLI::Range(0, kDayMs))
        ->type_name("MS")
        ->envname(environment_name(flag));
  }
  void bytes(const std::string& flag, std::size_t& target, const std::string& help) {
    value(flag, target, help + "; units kb, mb, gb are powers of 1024")
        ->transform(CLI::AsSizeValue(false))
        ->type_name("BYTES");
  }

 private:
  CLI::App& app_;
};

}  // namespace

void add_options(CLI::App& app, ServerConfig& config) {
  app.set_config("--config", "", "file of key=value lines, a key for each flag below");
  app.allow_config_extras(CLI::config_extras_mode::error);
  Knobs knobs(app);
  knobs.value("--listen", config.listen, "host:port (port 0 = any free one) or unix:PATH");
  knobs.value("--shared-memory", config.shared_memory,
              "PATH of a socket at which clients of this machine and user get memory for planes; "
              "empty = none");
  knobs.value("--admin", config.admin,
              "host:port of the live page, /healthz, /readyz and /metrics; empty = none");
  app.add_flag("--admin-previews", config.admin_previews,
               "the live page also shows the last frame of each session")
      ->envname(environment_name("--admin-previews"));
  app.add_flag("--allow-remote", config.allow_remote,
               "addresses that other machines can reach may be listened on")
      ->envname(environment_name("--allow-remote"));
  knobs.value("--threads", config.threads, "threads that filter; 0 = one for each core")
      ->check(CLI::Range(0, 1024));
  knobs.value("--log-level", config.log_level, "trace, debug, info, warn, error or off");
  knobs.value("--max-sessions", config.limits.max_sessions, "sessions that may exist at once")
      ->check(CLI::Range(1, 100000));
  knobs.value("--max-streams", config.max_streams, "streams that may be open at once")
      ->check(CLI::Range(1, 100000));
  knobs
      .value("--max-waiting-per-address", config.max_waiting_per_address,
             "streams of one IPv4 address or IPv6 /64 network that have not said Hello; 0 = no "
             "limit")
      ->check(CLI::Range(0, 100000));
  knobs
      .value("--max-dimension", config.limits.max_dimension, "pixels, width and height of a frame")
      ->check(CLI::Range(1, kMaxDimension));
  knobs.bytes("--max-session-bytes", config.limits.max_session_bytes, "memory of one session");
  knobs.bytes("--max-total-bytes", config.limits.max_total_bytes, "memory of all sessions");
  knobs.value("--credits", config.limits.credits, "frames in flight for each session")
      ->check(CLI::Range(1, 16));
  knobs
      .value("--max-frames-per-second", config.limits.max_frames_per_second,
             "of each session, beyond which its stream is read no faster; 0 = no limit")
      ->check(CLI::Range(0.0, 100000.0));
  knobs.bytes("--max-bytes-per-second", config.limits.max_bytes_per_second,
              "that each session may send, in the same way; 0 = no limit");
  knobs
      .value(
          "--max-load", config.limits.max_load,
          "share of the time of the threads that filter, which sessions that tell their rate may "
          "take together, 0..1; 0 = no limit")
      ->check(CLI::Range(0.0, 1.0));
  knobs.value("--max-sessions-per-token", config.limits.max_sessions_per_token,
              "made with the same bearer token; 0 = no limit");
  knobs.milliseconds("--linger-ms", config.limits.linger,
                     "how long a session is kept without a stream");
  knobs.milliseconds("--drain-ms", config.drain_deadline,
                     "time for frames in flight when told to stop");
  knobs.milliseconds("--keepalive-ms", config.keepalive, "silence after which a peer is asked");
  knobs.milliseconds("--keepalive-timeout-ms", config.keepalive_timeout,
                     "silence after that for which it is lost");
  knobs.milliseconds("--hello-timeout-ms", config.hello_timeout,
                     "for the first message of a stream, after which it is ended; 0 = none");
  knobs.milliseconds("--frame-timeout-ms", config.frame_timeout,
                     "for a frame that has begun, after which it fails and its stream is ended; "
                     "0 = none");
  knobs.value("--tls-cert", config.tls.certificate, "PEM file, chain of the server");
  knobs.value("--tls-key", config.tls.key, "PEM file, its private key");
  knobs.value("--tls-client-ca", config.tls.client_ca,
              "PEM file of the authorities whose certificates clients must show");
  knobs.value("--token-file", config.token_file,
              "bearer tokens of clients, one a line; empty = none asked for");
}

std::string options_text(const CLI::App& app) { return app.config_to_str(true, false); }

}  // namespace holdfast::server
