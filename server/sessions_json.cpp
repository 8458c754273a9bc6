#include "server/sessions_json.h"

#include <nlohmann/json.hpp>

#include "server/version.h"

namespace holdfast::server {
namespace {

using Json = nlohmann::ordered_json;

Json session_json(const SessionTable::Listed& listed, std::chrono::steady_clock::time_point now) {
  const SessionConfig config = *listed.session->config();
  const SessionWatch::Glance glance = listed.watch->glance(now);
  Json ms = Json::object();
  for (std::size_t stage = 0; stage < kWatchedStages.size(); ++stage)
    ms[kWatchedStages[stage]] = {{"p50", glance.p50[stage]}, {"p95", glance.p95[stage]}};
  return {{"session", listed.watch->ordinal()},
          {"width", config.denoiser.width},
          {"height", config.denoiser.height},
          {"recipe", config.denoiser.recipe},
          {"preset", glance.preset.empty() ? config.denoiser.preset : glance.preset},
          {"wire", config.wire},
          {"streaming", listed.streaming},
          {"frames_per_second", glance.frames_per_second},
          {"frames", glance.frames},
          {"dropped", glance.dropped},
          {"repeated", glance.repeated},
          {"errors", glance.errors},
          {"repaired_values", glance.repaired},
          {"history_frames", glance.history_frames},
          {"memory_bytes", listed.bytes},
          {"ms", ms}};
}

}  // namespace

std::string sessions_json(const ServiceState& state, std::chrono::steady_clock::time_point now) {
  Json sessions = Json::array();
  for (const SessionTable::Listed& listed : state.sessions.list())
    sessions.push_back(session_json(listed, now));
  const std::chrono::duration<double> uptime = now - state.started;
  return Json{{"version", kVersion},
              {"ready", !state.draining},
              {"uptime_s", uptime.count()},
              {"streams", state.streams.size()},
              {"session_bytes", state.sessions.session_bytes()},
              {"scratch_bytes", state.sessions.scratch_bytes()},
              {"max_total_bytes", state.config.limits.max_total_bytes},
              {"load", state.sessions.load()},
              {"max_load", state.config.limits.max_load},
              {"previews", state.config.admin_previews},
              {"stages", kWatchedStages},
              {"sessions", sessions}}
      .dump();
}

}  // namespace holdfast::server
