#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "client/cli/access_options.h"

namespace holdfast::cli {

/// How a sequence is streamed through a server.
struct ReplayOptions {
  std::filesystem::path dir;  ///< the sequence
  std::filesystem::path out;  ///< where frame.####.exr files are written; made if need be
  std::string server;         ///< host:port or unix:PATH; empty = a server in this process
  Access access;              ///< what that server asks for
  int threads = 0;            ///< of the server in this process; 0 = one for each core
  std::string recipe = "reliable";
  std::string preset = "balanced";
  std::string indirect_basis;                ///< empty = the preset's
  std::vector<std::string> half_resolution;  ///< empty = the preset's
  std::string history;                       ///< empty = the preset's
  std::string wire = "exact";
  double budget_ms = 0;             ///< wished time of a frame in the core; 0 = none
  std::vector<std::string> layers;  ///< result planes to write; empty = all
  std::int64_t first = std::numeric_limits<std::int64_t>::min();  ///< frames with smaller indices
  std::int64_t last = std::numeric_limits<std::int64_t>::max();   ///< or larger ones are left out
  double fps = 0;            ///< frames submitted a second; 0 = as fast as they are answered
  int reconnect_ms = 10000;  ///< a lost server is waited for that long
  bool debug = false;        ///< also motion, history and confidence of each component
  bool quiet = false;        ///< no progress
};

/// What happened, for all frames in order.
struct ReplayResult {
  std::int64_t frames = 0;
  std::string recipe, preset;          ///< the preset of most frames
  std::map<std::string, int> presets;  ///< frames by preset
  bool shared_memory_asked = false;    ///< for
  bool shared_memory = false;          ///< and got: planes went through it
  bool with_budget = false;            ///< presets were chosen to keep to one
  int width = 0, height = 0;
  std::vector<double> core_ms;       ///< of each frame, inside the denoiser
  std::vector<double> total_ms;      ///< from submit to the last byte back, queueing included
  std::uint64_t bytes_in = 0;        ///< plane bytes sent to the server
  std::uint64_t bytes_out = 0;       ///< plane bytes received from it
  std::uint64_t non_finite_in = 0;   ///< values that the server repaired on the way in
  std::uint64_t non_finite_out = 0;  ///< result values that are not finite
};

/// Streams a sequence through a server and writes the results. Throws InputError for a bad sequence
/// or option, or for the first frame that the server finds to break a rule; ServerUnreachable;
/// std::runtime_error if the server fails at a frame or a file cannot be written.
ReplayResult replay_sequence(const ReplayOptions& options);

/// The machine-readable form of a result.
nlohmann::ordered_json replay_json(const ReplayResult& result);

}  // namespace holdfast::cli
