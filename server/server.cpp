#include "server/server.h"

#include <condition_variable>
#include <mutex>
#include <thread>

#include <grpcpp/ext/proto_server_reflection_plugin.h>
#include <grpcpp/grpcpp.h>

#include "core/frame/error.h"
#include "proto/one_poller.h"
#include "proto/plane_bytes.h"
#include "server/admin_http.h"
#include "server/credentials.h"
#include "server/denoise_service.h"
#include "server/listen_address.h"
#include "server/log.h"
#include "server/session_service.h"
#include "server/sessions_json.h"
#include "server/shared_memory_socket.h"
#include "server/version.h"

namespace holdfast::server {
namespace {

constexpr int kHttp2FrameBytes = 1 << 20;  // fewer, larger frames: less CPU for large messages
constexpr std::chrono::seconds kExpiryPeriod{1};

constexpr std::chrono::milliseconds kRatePeriod{5};  // how exactly limits on rates are kept
constexpr int kMinPingMs = 5000;                     // between a client's own pings

int milliseconds(std::chrono::milliseconds time) { return static_cast<int>(time.count()); }

const ServerConfig& checked(const ServerConfig& config) {
  check_config(config);
  check_listen_address(config.listen);
  return config;
}

/// How often streams look at the clock: often enough that no limit is overrun by more than a
/// quarter, nor by more than a second.
std::chrono::milliseconds tick_period(const ServerConfig& config) {
  std::chrono::milliseconds period{1000};
  for (const auto limit : {config.hello_timeout, config.frame_timeout})
    if (limit.count() > 0) period = std::min(period, limit / 4);
  const SessionLimits& limits = config.limits;
  if (limits.max_frames_per_second > 0 || limits.max_bytes_per_second > 0) period = kRatePeriod;
  return std::max(period, std::chrono::milliseconds(5));
}

/// Calls `work` once a period on a thread of its own, until destroyed.
class Timer {
 public:
  template <class F>
  Timer(std::chrono::milliseconds period, F work)
      : thread_([this, period, work] {
          std::unique_lock lock(mutex_);
          while (!wake_.wait_for(lock, period, [this] { return stopping_; })) work();
        }) {}
  ~Timer() {
    {
      const std::lock_guard lock(mutex_);
      stopping_ = true;
    }
    wake_.notify_all();
    thread_.join();
  }

 private:
  std::mutex mutex_;
  std::condition_variable wake_;
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace

class Server::Impl {
 public:
  explicit Impl(const ServerConfig& config)
      : state_(checked(config), make_logger(config.log_level)),
        session_service_(state_),
        denoise_service_(state_) {
    if (!config.shared_memory.empty())  // first, so that whoever gets a session can ask for it
      shared_memory_.emplace(config.shared_memory, state_.shared_memory, state_.log);
    start();
    expiry_.emplace(kExpiryPeriod, [this] {
      if (const int ended = state_.sessions.expire(); ended > 0) expired(ended);
    });
    ticks_.emplace(tick_period(config),
                   [this] { state_.streams.tick(std::chrono::steady_clock::now()); });
    if (!config.admin.empty()) start_admin();
  }

  ~Impl() {
    admin_.reset();
    server_->Shutdown(std::chrono::system_clock::now());
    server_->Wait();
    // A stream is gone only after its OnDone, which may run after Wait.
    state_.streams.wait_empty(std::chrono::seconds(10));
    state_.log->info("event=stopped address={}", address_);
  }

  void drain(std::chrono::milliseconds deadline) {
    state_.log->info("event=drain deadline_ms={} sessions={}", deadline.count(),
                     state_.sessions.size());
    state_.draining = true;
    if (auto* health = server_->GetHealthCheckService()) health->SetServingStatus(false);
    state_.streams.drain(deadline);
    if (!state_.streams.wait_empty(deadline))
      state_.log->warn("event=drain_deadline: open streams are cut");
  }

  const std::string& address() const { return address_; }
  std::string admin_address() const { return admin_ ? admin_->address() : std::string(); }

 private:
  void expired(int count) {
    state_.metrics.session_ended("expired", count);
    state_.log->info("event=session_expire count={}", count);
  }

  void start_admin() {
    const auto ready = [this] { return !state_.draining; };
    const auto metrics = [this, ready] {
      return state_.metrics.text({state_.sessions.size(), state_.streams.size(),
                                  state_.sessions.session_bytes(), state_.sessions.scratch_bytes(),
                                  state_.sessions.load(), ready()});
    };
    const auto sessions = [this] {
      return sessions_json(state_, std::chrono::steady_clock::now());
    };
    const auto preview = [this](int ordinal) { return preview_png(ordinal); };
    admin_.emplace(state_.config.admin, AdminPages{ready, metrics, sessions, preview});
    state_.log->info("event=admin_listening address={}", admin_->address());
  }

  std::string preview_png(int ordinal) {
    if (!state_.config.admin_previews) return {};
    for (const SessionTable::Listed& listed : state_.sessions.list()) {
      if (listed.watch->ordinal() != ordinal) continue;
      const Rgb8 picture = listed.watch->preview().look(std::chrono::steady_clock::now());
      return picture.values.empty() ? std::string() : png(picture);
    }
    return {};
  }
  void start() {
    const std::string& listen = state_.config.listen;
    grpc::EnableDefaultHealthCheckService(true);
    grpc::reflection::InitProtoReflectionServerBuilderPlugin();
    grpc::ServerBuilder builder;
    int port = 0;
    builder.AddListeningPort(listen, make_credentials(state_.config.tls), &port);
    builder.SetMaxReceiveMessageSize(wire::kMaxMessageBytes);
    builder.AddChannelArgument(GRPC_ARG_HTTP2_MAX_FRAME_SIZE, kHttp2FrameBytes);
    builder.AddChannelArgument(GRPC_ARG_ALLOW_REUSEPORT, 0);
    builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_TIME_MS, milliseconds(state_.config.keepalive));
    builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_TIMEOUT_MS,
                               milliseconds(state_.config.keepalive_timeout));
    if (state_.config.hello_timeout.count() > 0)  // connections that say nothing at all
      builder.AddChannelArgument(GRPC_ARG_SERVER_HANDSHAKE_TIMEOUT_MS,
                                 milliseconds(state_.config.hello_timeout));
    builder.AddChannelArgument(GRPC_ARG_HTTP2_MIN_RECV_PING_INTERVAL_WITHOUT_DATA_MS, kMinPingMs);
    builder.AddChannelArgument(GRPC_ARG_HTTP2_MAX_PINGS_WITHOUT_DATA, 0);
    // The probe finds the window of a long link; within a machine it finds far too large a one.
    if (is_local_address(listen)) {
      builder.AddChannelArgument(GRPC_ARG_HTTP2_BDP_PROBE, 0);
      builder.AddChannelArgument(GRPC_ARG_HTTP2_STREAM_LOOKAHEAD_BYTES, wire::kMaxMessageBytes);
    }
    builder.RegisterService(&session_service_);
    builder.RegisterService(&denoise_service_);
    server_ = builder.BuildAndStart();
    if (!server_) throw InputError("listen address " + listen, "must be free", "not available");
    address_ = listen;
    if (!listen.starts_with("unix:"))
      address_ = listen.substr(0, listen.rfind(':') + 1) + std::to_string(port);
    if (auto* health = server_->GetHealthCheckService()) health->SetServingStatus(true);
    state_.log->info("event=listening address={} threads={} version={}", address_,
                     state_.scheduler.threads(), kVersion);
    if (!is_local_address(listen) && state_.config.tls.certificate.empty())
      state_.log->warn("event=exposed address={}: traffic is not encrypted", address_);
  }

  ServiceState state_;
  SessionService session_service_;
  DenoiseService denoise_service_;
  std::string address_;
  const std::shared_ptr<void> one_poller_ = wire::hold_one_poller();
  std::unique_ptr<grpc::Server> server_;
  std::optional<SharedMemorySocket> shared_memory_;
  std::optional<Timer> expiry_, ticks_;
  std::optional<AdminHttp> admin_;
};

Server::Server(const ServerConfig& config) : impl_(std::make_unique<Impl>(config)) {}
Server::~Server() = default;
const std::string& Server::address() const { return impl_->address(); }
std::string Server::admin_address() const { return impl_->admin_address(); }
void Server::drain(std::chrono::milliseconds deadline) { impl_->drain(deadline); }

}  // namespace holdfast::server
