#pragma once

#include <chrono>
#include <string>

#include "server/service_state.h"

namespace holdfast::server {

/// What the live page shows, as JSON: the server, and each session by its ordinal. No id, no token,
/// no address of a client is in it.
///
///   {"version", "ready", "uptime_s", "streams", "session_bytes", "scratch_bytes",
///    "max_total_bytes", "previews", "stages": [NAME...],
///    "sessions": [{"session", "width", "height", "recipe", "preset", "wire", "streaming",
///                  "frames_per_second", "frames", "dropped", "repeated", "errors",
///                  "repaired_values", "history_frames", "memory_bytes",
///                  "ms": {NAME: {"p50", "p95"}...}}...]}
std::string sessions_json(const ServiceState& state, std::chrono::steady_clock::time_point now);

}  // namespace holdfast::server
