#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace holdfast::cli {

/// What `holdfast bench --transport` runs.
struct TransportOptions {
  int width = 1920, height = 546;  ///< pixels; 32 bytes of each go up: 32 MiB
  int frames = 24;                 ///< timed frames of a round, >= 1
  int rounds = 5;                  ///< >= 1; medians are over them
  std::string wire = "exact";
  double delay_ms = 0;  ///< > 0: also over TCP with that delay in each direction, by a relay
};

/// One kind of link, as medians over rounds. Bytes are those of planes, both directions together.
struct LinkResult {
  std::string link;  ///< "tcp", "unix", "shared" (memory, beside a plain unix socket), or
                     ///< "delayed", whose plain socket has no delay
  double raw_gb_per_s = 0, session_gb_per_s = 0;
  double ratio = 0;                                       ///< session over raw, of the same round
  double raw_cpu_s_per_gb = 0, session_cpu_s_per_gb = 0;  ///< both ends
  double memory_frames = 0;  ///< of the server above what it had before the first frame, over the
                             ///< bytes of a frame, up and down
};

struct TransportResult {
  TransportOptions options;
  std::size_t up_bytes = 0, down_bytes = 0;  ///< of a frame
  std::vector<LinkResult> links;
};

/// Measures one session against a plain socket that moves the same bytes in the same pieces.
///
/// Server (a process of its own), client library, session and stream are those of every user. What
/// is kept out is the filter alone: after the first frame, which is filtered, the client sends the
/// same index again, and by the protocol a repeated frame is received and decoded like any other
/// and answered with the results of the first time. Rounds alternate between raw and session.
/// Throws InputError for a bad option.
TransportResult run_transport_bench(const TransportOptions& options);

/// The machine-readable form of a result, and the same for people.
nlohmann::ordered_json transport_json(const TransportResult& result);
std::string transport_text(const TransportResult& result);

}  // namespace holdfast::cli
