#include "server/session_change.h"

#include "server/convert.h"
#include "server/session_costs.h"
#include "server/status.h"

namespace holdfast::server {
namespace {

bool same_choice(const DenoiserConfig& a, const DenoiserConfig& b) {
  return a.width == b.width && a.height == b.height && a.recipe == b.recipe && a.preset == b.preset;
}

}  // namespace

std::optional<v1::FrameError> take_change(ServiceState& state,
                                          const std::shared_ptr<Session>& session,
                                          const v1::FrameBegin& frame,
                                          std::shared_ptr<const SessionConfig>& config,
                                          std::shared_ptr<void>& reserved) try {
  reserved.reset();
  if (!frame.has_change()) return {};
  SessionConfig next = changed_config(frame.change(), *config);
  const DenoiserConfig& core = next.denoiser;
  if (same_choice(core, config->denoiser)) return {};
  expect_costs(state.costs, next);
  reserved = state.sessions.reserve(session, next);
  state.log->info("event=session_change session={} size={}x{} recipe={} preset={}", session->id(),
                  core.width, core.height, core.recipe, core.preset);
  config = std::make_shared<const SessionConfig>(std::move(next));
  return {};
} catch (...) {
  state.metrics.refused(std::current_exception());
  return frame_error_from(std::current_exception());
}

}  // namespace holdfast::server
