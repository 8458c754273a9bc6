#include <grpcpp/create_channel.h>
#include <grpcpp/security/credentials.h>
#include <grpcpp/support/channel_arguments.h>
#include <holdfast/client.h>

#include "client/sdk/connection.h"
#include "client/sdk/convert.h"
#include "client/sdk/status.h"
#include "holdfast/v1/session_service.grpc.pb.h"
#include "proto/plane_bytes.h"

namespace holdfast::client {
namespace {

constexpr int kHttp2FrameBytes = 1 << 20;  // fewer, larger frames: less CPU for large messages

std::shared_ptr<grpc::Channel> make_channel(const std::string& address) {
  grpc::ChannelArguments args;
  args.SetMaxReceiveMessageSize(wire::kMaxMessageBytes);
  args.SetInt(GRPC_ARG_HTTP2_MAX_FRAME_SIZE, kHttp2FrameBytes);
  args.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);  // one connection for each session
  args.SetInt(GRPC_ARG_ENABLE_HTTP_PROXY, 0);
  // The probe finds the window of a long link; a unix socket has none to find.
  if (address.starts_with("unix:")) {
    args.SetInt(GRPC_ARG_HTTP2_BDP_PROBE, 0);
    args.SetInt(GRPC_ARG_HTTP2_STREAM_LOOKAHEAD_BYTES, wire::kMaxMessageBytes);
  }
  return grpc::CreateCustomChannel(address, grpc::InsecureChannelCredentials(), args);
}

void check(const std::string& address, const grpc::Status& status) {
  if (!status.ok()) throw_status(address, status);
}

}  // namespace

class Session::Impl {
 public:
  explicit Impl(const SessionOptions& options)
      : address_(options.address),
        timeout_(options.connect_timeout),
        channel_(make_channel(address_)),
        sessions_(channel_),
        denoise_(channel_) {
    create(options);
    v1::Hello hello;
    hello.set_session_id(session_.session_id());
    hello.set_token(session_.token());
    try {
      connection_.emplace(
          denoise_,
          Connection::Config{address_, options.planes, results_, options.width, options.height},
          hello, timeout_);
    } catch (...) {
      remove();
      throw;
    }
  }

  ~Impl() {
    if (!closed_) remove();
  }

  void close() {
    if (closed_) return;
    connection_->finish();
    const grpc::Status status = connection_->wait_end();
    remove();
    check(address_, status);
  }

  Connection& connection() { return *connection_; }
  const Connection& connection() const { return *connection_; }
  const std::vector<PlaneId>& results() const { return results_; }
  const v1::CreateSessionResponse& session() const { return session_; }

 private:
  void create(const SessionOptions& options) {
    v1::CreateSessionRequest request;
    write_create_request(options, request);
    grpc::ClientContext context;
    context.set_deadline(std::chrono::system_clock::now() + timeout_);
    check(address_, sessions_.CreateSession(&context, request, &session_));
    for (const std::string& name : session_.result_planes()) {
      const std::optional<PlaneId> id = plane_from_name(name);
      if (!id) throw RefusedError("server " + address_ + " returns an unknown plane " + name);
      results_.push_back(*id);
    }
  }

  /// Ends the session on the server; it would otherwise linger. Failure changes nothing for us.
  void remove() {
    closed_ = true;
    v1::DeleteSessionRequest request;
    request.set_session_id(session_.session_id());
    request.set_token(session_.token());
    v1::DeleteSessionResponse response;
    grpc::ClientContext context;
    context.set_deadline(std::chrono::system_clock::now() + timeout_);
    sessions_.DeleteSession(&context, request, &response);
  }

  const std::string address_;
  const std::chrono::milliseconds timeout_;
  const std::shared_ptr<grpc::Channel> channel_;
  v1::SessionService::Stub sessions_;
  v1::DenoiseService::Stub denoise_;
  v1::CreateSessionResponse session_;
  std::vector<PlaneId> results_;
  std::optional<Connection> connection_;
  bool closed_ = false;
};

Session::Session(const SessionOptions& options) : impl_(std::make_unique<Impl>(options)) {}
Session::~Session() = default;
Session::Session(Session&&) noexcept = default;
Session& Session::operator=(Session&&) noexcept = default;

void Session::submit(std::shared_ptr<const Frame> frame) {
  impl_->connection().submit(std::move(frame), true);
}
void Session::submit(Frame&& frame) { submit(std::make_shared<const Frame>(std::move(frame))); }
bool Session::try_submit(std::shared_ptr<const Frame> frame) {
  return impl_->connection().submit(std::move(frame), false);
}
std::optional<FrameOutput> Session::receive() { return impl_->connection().receive(true); }
std::optional<FrameOutput> Session::try_receive() { return impl_->connection().receive(false); }
void Session::finish() { impl_->connection().finish(); }
void Session::close() { impl_->close(); }
void Session::recycle(PlaneSet&& planes) { impl_->connection().recycle(std::move(planes)); }
int Session::credits() const { return impl_->connection().credits(); }
int Session::in_flight() const { return impl_->connection().in_flight(); }
const std::vector<PlaneId>& Session::results() const { return impl_->results(); }
const std::string& Session::recipe() const { return impl_->session().recipe(); }
const std::string& Session::preset() const { return impl_->session().preset(); }
Traffic Session::traffic() const { return impl_->connection().traffic(); }

}  // namespace holdfast::client
