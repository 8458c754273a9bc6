#include "client/sdk/session_keeper.h"

#include <algorithm>

#include "client/sdk/channel.h"
#include "client/sdk/convert.h"
#include "client/sdk/shared_memory.h"
#include "client/sdk/status.h"
#include "proto/one_poller.h"
#include "proto/unix_buffers.h"

namespace holdfast::client {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr milliseconds kFirstPause{20}, kLongestPause{500};  // between attempts, doubling

void check(const std::string& address, const grpc::Status& status) {
  if (!status.ok()) throw_status(address, status);
}

/// Whether another attempt may succeed. A server that dies behind a proxy shows as UNKNOWN. Nobody
/// else knows the session's token, so a newer stream that has it (ABORTED) is an older one of ours:
/// cancelled, but its Hello was read after that of the one that followed.
bool passing(const grpc::Status& status) {
  return status.error_code() == grpc::StatusCode::UNAVAILABLE ||
         status.error_code() == grpc::StatusCode::UNKNOWN ||
         status.error_code() == grpc::StatusCode::ABORTED ||
         status.error_code() == grpc::StatusCode::DEADLINE_EXCEEDED;
}

const wire::WireProfile& profile_of(const std::string& name) {
  const wire::WireProfile* const profile = wire::find_profile(name.empty() ? "exact" : name);
  if (profile != nullptr) return *profile;
  std::string names;
  for (const std::string& known : wire::profile_names())
    names += (names.empty() ? "" : ", ") + known;
  throw InputError("wire", "must be one of " + names, "\"" + name + "\"");
}

}  // namespace

SessionKeeper::SessionKeeper(const SessionOptions& options, Exchange& exchange)
    : options_(options),
      wire_(profile_of(options.wire)),
      exchange_(exchange),
      one_poller_(wire::hold_one_poller()),
      channel_(make_channel(options)),
      sessions_(channel_),
      denoise_(channel_) {
  check_shared_memory_path(options.shared_memory);
  create(session_);
  for (const std::string& name : session_.result_planes()) {
    const std::optional<PlaneId> id = plane_from_name(name);
    if (!id) throw RefusedError("server " + options.address + " returns an unknown plane " + name);
    results_.push_back(*id);
  }
  if (const grpc::Status status = open(true, options.connect_timeout); !status.ok()) {
    remove();
    throw_status(options.address, status);
  }
  thread_ = std::thread([this] { run(); });
}

SessionKeeper::~SessionKeeper() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
    if (connection_) connection_->cancel();
  }
  wake_.notify_all();
  if (thread_.joinable()) thread_.join();
  connection_.reset();
  remove();
}

void SessionKeeper::pump() {
  const std::lock_guard lock(mutex_);
  if (connection_) connection_->pump();
}

void SessionKeeper::wait_closed() {
  if (thread_.joinable()) thread_.join();
  remove();
}

void SessionKeeper::create(v1::CreateSessionResponse& session) {
  v1::CreateSessionRequest request;
  write_create_request(options_, request);
  grpc::ClientContext context;
  context.set_deadline(std::chrono::system_clock::now() + options_.connect_timeout);
  if (!options_.bearer_token.empty())
    context.AddMetadata("authorization", "Bearer " + options_.bearer_token);
  check(options_.address, sessions_.CreateSession(&context, request, &session));
  id_ = session.session_id();
  token_ = session.token();
  may_share_ = session.shared_memory();
}

grpc::Status SessionKeeper::open(bool fresh, milliseconds timeout) {
  v1::Hello hello;
  hello.set_session_id(id_);
  hello.set_token(token_);
  if (const auto last = exchange_.last_answered()) {
    hello.set_has_last_acked_frame(true);
    hello.set_last_acked_frame(*last);
  }
  SharedMemoryOffer offer;
  if (may_share_) offer = ask_for_shared_memory(options_.shared_memory, id_, token_);
  hello.set_shared_memory(offer.name);
  auto connection = std::make_unique<Connection>(
      denoise_, exchange_,
      Connection::Config{options_.planes, results_, &wire_, fresh, offer.memory}, hello);
  const grpc::Status status = connection->wait_open(timeout);
  if (!status.ok()) return status;
  wire::widen_unix_buffers(options_.address);
  shared_memory_ = connection->shared_memory();
  const std::lock_guard lock(mutex_);
  connection_ = std::move(connection);
  if (stopping_) connection_->cancel();
  connection_->pump();
  return status;
}

void SessionKeeper::run() {
  for (;;) {
    grpc::Status status = connection_->wait_end();  // replaced by this thread alone
    if (ends(status) || !reopen(status)) return;
  }
}

/// True if the session is over; else it has to be opened again.
bool SessionKeeper::ends(const grpc::Status& status) {
  const std::lock_guard lock(mutex_);
  if (exchange_.complete() && (status.ok() || passing(status))) {
    exchange_.close(nullptr);
    return true;
  }
  const bool again = passing(status) || status.ok();
  if (!stopping_ && again && options_.reconnect_timeout.count() > 0) return false;
  try {
    check(options_.address, status);
    throw ConnectionError("server " + options_.address + " ended the stream with frames in flight");
  } catch (...) {
    exchange_.close(std::current_exception());
  }
  return true;
}

/// False, and the exchange is closed, if it cannot be.
bool SessionKeeper::reopen(grpc::Status& status) try {
  const Clock::time_point deadline = Clock::now() + options_.reconnect_timeout;
  {
    std::unique_ptr<Connection> lost;  // its end takes no mutex
    const std::lock_guard lock(mutex_);
    lost = std::move(connection_);
  }
  bool fresh = false;
  for (milliseconds wait = kFirstPause;; wait = std::min(2 * wait, kLongestPause)) {
    try {
      if (status.error_code() == grpc::StatusCode::NOT_FOUND) {
        v1::CreateSessionResponse session;
        create(session);
        fresh = true;
      }
      status = open(fresh, options_.connect_timeout);
      if (status.ok()) return true;
      if (status.error_code() != grpc::StatusCode::NOT_FOUND && !passing(status))
        throw_status(options_.address, status);
    } catch (const ConnectionError&) {
      if (Clock::now() >= deadline) throw;
    }
    if (Clock::now() >= deadline) check(options_.address, status);
    if (!pause(wait)) throw ConnectionError("the session was ended");
  }
} catch (...) {
  exchange_.close(std::current_exception());
  return false;
}

/// False if the keeper stops.
bool SessionKeeper::pause(milliseconds time) {
  std::unique_lock lock(mutex_);
  return !wake_.wait_for(lock, time, [this] { return stopping_; });
}

/// Ends the session on the server; it would otherwise linger. Failure changes nothing for us.
void SessionKeeper::remove() {
  if (std::exchange(removed_, true)) return;
  v1::DeleteSessionRequest request;
  request.set_session_id(id_);
  request.set_token(token_);
  v1::DeleteSessionResponse response;
  grpc::ClientContext context;
  context.set_deadline(std::chrono::system_clock::now() + options_.connect_timeout);
  sessions_.DeleteSession(&context, request, &response);
}

}  // namespace holdfast::client
