#include "server/session_service.h"

#include <utility>

#include "proto/plane_bytes.h"
#include "proto/wire_profile.h"
#include "server/convert.h"
#include "server/error.h"
#include "server/session_costs.h"
#include "server/status.h"
#include "server/version.h"

namespace holdfast::server {
namespace {

/// google.rpc's QuotaFailure and RetryInfo have no package of their own in our distribution; the
/// same facts go as trailing metadata.
void add_quota(grpc::CallbackServerContext& context, std::exception_ptr error) {
  try {
    std::rethrow_exception(std::move(error));
  } catch (const RefusedError& refusal) {
    const Quota& quota = refusal.quota();
    if (!quota.limit.empty()) context.AddTrailingMetadata("holdfast-quota", quota.limit);
    if (quota.retry_after.count() > 0)
      context.AddTrailingMetadata("holdfast-retry-after-ms",
                                  std::to_string(quota.retry_after.count()));
  } catch (...) {  // others have no quota
  }
}

std::string authorization(const grpc::CallbackServerContext& context) {
  const auto& metadata = context.client_metadata();
  const auto it = metadata.find("authorization");
  return it == metadata.end() ? "" : std::string(it->second.data(), it->second.size());
}

/// Runs `work` and ends the call with OK or with the translation of what it threw.
template <class F>
void answer(Metrics& metrics, grpc::CallbackServerContext* context,
            grpc::ServerUnaryReactor* reactor, F&& work) {
  grpc::Status status;
  try {
    work();
  } catch (...) {
    status = status_from(std::current_exception());
    metrics.refused(std::current_exception());
    add_quota(*context, std::current_exception());
  }
  reactor->Finish(status);
}

/// The same for a call that has not been given its reactor yet.
template <class F>
grpc::ServerUnaryReactor* answer(Metrics& metrics, grpc::CallbackServerContext* context, F&& work) {
  grpc::ServerUnaryReactor* const reactor = context->DefaultReactor();
  answer(metrics, context, reactor, std::forward<F>(work));
  return reactor;
}

}  // namespace

grpc::ServerUnaryReactor* SessionService::GetServerInfo(grpc::CallbackServerContext* context,
                                                        const v1::GetServerInfoRequest*,
                                                        v1::GetServerInfoResponse* response) {
  return answer(state_.metrics, context, [&] {
    response->set_version(kVersion);
    for (const std::string& name : recipe_names()) response->add_recipes(name);
    for (const std::string& name : preset_names()) response->add_presets(name);
    for (const std::string& name : wire::profile_names()) response->add_wires(name);
    response->set_max_dimension_px(static_cast<std::uint32_t>(state_.config.limits.max_dimension));
    response->set_max_chunk_bytes(wire::kMaxChunkBytes);
    response->set_max_sessions(static_cast<std::uint32_t>(state_.config.limits.max_sessions));
    response->set_sessions(static_cast<std::uint32_t>(state_.sessions.size()));
    response->set_threads(static_cast<std::uint32_t>(state_.scheduler.threads()));
    response->set_load(state_.sessions.load());
    response->set_max_load(state_.config.limits.max_load);
  });
}

grpc::ServerUnaryReactor* SessionService::CreateSession(grpc::CallbackServerContext* context,
                                                        const v1::CreateSessionRequest* request,
                                                        v1::CreateSessionResponse* response) {
  grpc::ServerUnaryReactor* const reactor = context->DefaultReactor();
  state_.session_jobs.post([=, this] {
    answer(state_.metrics, context, reactor, [&] { create(*context, *request, *response); });
  });
  return reactor;
}

void SessionService::create(const grpc::CallbackServerContext& context,
                            const v1::CreateSessionRequest& request,
                            v1::CreateSessionResponse& response) {
  const std::string owner = state_.tokens.check(authorization(context));
  if (state_.draining) throw RefusedError(Refusal::kDraining, "the server is shutting down");
  SessionConfig asked = session_config_from(request);
  asked.shared_memory = request.shared_memory() && !state_.config.shared_memory.empty();
  expect_costs(state_.costs, asked);
  const auto session = state_.sessions.create(std::move(asked), owner);
  const SessionConfig config = *session->config();
  response.set_session_id(session->id());
  response.set_token(session->token());
  response.set_credits(static_cast<std::uint32_t>(state_.config.limits.credits));
  response.set_max_chunk_bytes(wire::kMaxChunkBytes);
  for (const PlaneId id : config.results) response.add_result_planes(plane_name(id));
  response.set_linger_ms(static_cast<std::uint32_t>(state_.config.limits.linger.count()));
  response.set_recipe(config.denoiser.recipe);
  response.set_preset(config.denoiser.preset);
  response.set_memory_bytes(state_.sessions.bytes(*session));
  response.set_shared_memory(config.shared_memory);
  state_.log->info(
      "event=session_create session={} size={}x{} planes={} recipe={} preset={} "
      "budget_ms={} frames_per_second={} load={:.3f} memory_mib={}",
      session->id(), config.denoiser.width, config.denoiser.height, config.denoiser.planes.size(),
      config.denoiser.recipe, config.denoiser.preset, config.budget_ms, config.frames_per_second,
      config.load, response.memory_bytes() >> 20);
}

grpc::ServerUnaryReactor* SessionService::GetSession(grpc::CallbackServerContext* context,
                                                     const v1::GetSessionRequest* request,
                                                     v1::GetSessionResponse* response) {
  return answer(state_.metrics, context, [&] {
    const auto session = state_.sessions.find(request->session_id(), request->token());
    const SessionCounters counters = session->counters();
    response->set_streaming(state_.sessions.attached(*session));
    response->set_has_last_frame(counters.last_frame.has_value());
    response->set_last_frame_index(counters.last_frame.value_or(0));
    response->set_frames(counters.frames);
    response->set_frame_errors(counters.frame_errors);
    response->set_memory_bytes(state_.sessions.bytes(*session));
    response->set_plan(session->plan_text());
  });
}

grpc::ServerUnaryReactor* SessionService::DeleteSession(grpc::CallbackServerContext* context,
                                                        const v1::DeleteSessionRequest* request,
                                                        v1::DeleteSessionResponse*) {
  grpc::ServerUnaryReactor* const reactor = context->DefaultReactor();
  state_.session_jobs.post([=, this] {
    answer(state_.metrics, context, reactor, [&] {
      state_.sessions.remove(request->session_id(), request->token());
      state_.metrics.session_ended("deleted", 1);
      state_.streams.close_session(request->session_id());
      state_.log->info("event=session_delete session={}", request->session_id());
    });
  });
  return reactor;
}

}  // namespace holdfast::server
