#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "client/cli/access_options.h"
#include "client/cli/relay.h"

namespace holdfast::cli {

/// Size of the frames of a session, pixels.
struct LoadSize {
  int width = 480, height = 270;
};

/// A load on a server.
struct LoadOptions {
  std::string server;            ///< host:port or unix:PATH; empty = a server in this process
  Access access;                 ///< what that server asks for
  int threads = 0;               ///< of the server in this process; 0 = one for each core
  std::string frames = "fence";  ///< a built-in scene, a scene file, or the folder of a sequence
  /// Sessions take the sizes in turn; a sequence has its own. Never empty.
  std::vector<LoadSize> sizes = std::vector<LoadSize>(1);
  int sessions = 1;
  /// Frames that each session sends a second, whether or not the server keeps up (open loop); 0 =
  /// the next when a credit is free (closed loop).
  double fps = 0;
  bool tell_rate = false;  ///< sessions tell the server `fps`, which may then refuse them
  double seconds = 10;     ///< for which frames are sent; the answers of all are waited for
  std::string recipe = "reliable";
  std::string preset = "balanced";
  Link link;           ///< between each session and the server
  double churn_s = 0;  ///< each client leaves after that long and comes back anew; 0 = never
  std::string wire = "exact";
  /// As a game: the server drops frames that newer ones have overtaken, and at a fixed rate a
  /// session leaves out frames whose successor is due before there is a credit for them.
  bool latest = false;
  double deadline_ms = 0;  ///< of the begin of filtering; 0 = none
};

/// Where the time of the answered frames went, milliseconds, one value a frame.
struct LoadTimes {
  std::vector<double> at_s;       ///< of the answer, seconds since the start of the load
  std::vector<double> latency;    ///< from when the frame was to be sent to its last result byte
  std::vector<double> client;     ///< of that: waiting for its turn and for a credit
  std::vector<double> queue;      ///< waiting in the server
  std::vector<double> filter;     ///< in the core
  std::vector<double> transport;  ///< the rest: both ways, with copies and flow control

  void add(const LoadTimes& other);
};

struct LoadResult {
  LoadOptions options;                       ///< with the sizes that were used
  std::int64_t clients = 0;                  ///< sessions that were made
  std::int64_t submitted = 0, answered = 0;  ///< answered: with planes
  std::int64_t dropped = 0;                  ///< by the server, which said so
  std::int64_t skipped = 0;                  ///< left out by the sessions themselves
  std::int64_t late = 0;                     ///< of all that were sent, beyond their deadline
  std::int64_t reconnects = 0;
  std::int64_t sharing = 0;                   ///< clients whose planes went through shared memory
  double elapsed_s = 0;                       ///< from the first submit to the last answer
  std::uint64_t bytes_in = 0, bytes_out = 0;  ///< plane bytes to the server and back
  LoadTimes times;
  std::map<std::string, std::int64_t> errors;  ///< by kind: invalid_frame, server_failed, refused,
                                               ///< connection

  double frames_per_second() const;
  void add(const LoadResult& other);
};

/// Runs the load. Throws InputError for bad options, ServerUnreachable if not one session can be
/// made; what fails later is counted.
LoadResult run_load(const LoadOptions& options);

/// The largest rate for each session at which 95 % of the latencies stay within
/// `goal_ms` and no frame fails, by doubling and bisection with `run_load`.
struct LoadSearch {
  double fps = 0;  ///< for each session; 0 if even the slowest rate tried misses the goal
  std::vector<LoadResult> runs;
};
LoadSearch search_load(LoadOptions options, double goal_ms);

/// The machine-readable form of a result.
nlohmann::ordered_json load_json(const LoadResult& result);
/// For a terminal.
std::string load_text(const LoadResult& result);
/// A page by itself: the figures, percentiles of latency over time and their distribution.
std::string load_html(const LoadResult& result);

/// The parts of the latency, in order, for those who print them.
struct LoadPart {
  const char* name;
  const std::vector<double> LoadTimes::*values;
};
inline constexpr LoadPart kLoadParts[] = {{"latency", &LoadTimes::latency},
                                          {"client", &LoadTimes::client},
                                          {"queue", &LoadTimes::queue},
                                          {"filter", &LoadTimes::filter},
                                          {"transport", &LoadTimes::transport}};
/// "480x270", or several with commas between.
std::string load_sizes(const LoadOptions& options);

}  // namespace holdfast::cli
