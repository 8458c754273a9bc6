#pragma once

#include <atomic>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <thread>

#include <holdfast/client.h>

#include "client/sdk/connection.h"
#include "client/sdk/exchange.h"
#include "holdfast/v1/session_service.grpc.pb.h"

namespace holdfast::client {

/// Keeps a session alive: makes it, opens its stream, and, on a thread of its own, opens another
/// one whenever the stream is lost, by a new session where the server does not know the old one.
///
///   open -- stream ends with UNAVAILABLE or UNKNOWN, or with frames unanswered --> lost
///   lost -- Hello is answered --> open             history as before, unanswered frames again
///   lost -- Hello finds no session (NOT_FOUND) --> new session, then open
///                                                  warmed with the last inputs
///   lost -- nothing for reconnect_timeout, or refused --> closed with that error
///   open -- all answered after finish --> closed
class SessionKeeper {
 public:
  /// Makes the session and opens the stream. Throws as Session's constructor.
  SessionKeeper(const SessionOptions& options, Exchange& exchange);
  /// Ends the session at once.
  ~SessionKeeper();

  /// The exchange has something new to send.
  void pump();
  /// Waits until the session is closed, and deletes it on the server.
  void wait_closed();

  const std::vector<PlaneId>& results() const { return results_; }
  const v1::CreateSessionResponse& session() const { return session_; }
  bool shared_memory() const { return shared_memory_; }

 private:
  void create(v1::CreateSessionResponse& session);
  grpc::Status open(bool fresh, std::chrono::milliseconds timeout);
  void run();
  bool ends(const grpc::Status& status);
  bool reopen(grpc::Status& status);
  bool pause(std::chrono::milliseconds time);
  void remove();

  const SessionOptions options_;
  const wire::WireProfile& wire_;
  Exchange& exchange_;
  const std::shared_ptr<void> one_poller_;
  const std::shared_ptr<grpc::Channel> channel_;
  v1::SessionService::Stub sessions_;
  grpc::GenericStub denoise_;
  v1::CreateSessionResponse session_;  ///< as it was first made: what the user is told
  std::string id_, token_;             ///< of the present one
  std::vector<PlaneId> results_;
  bool removed_ = false;
  bool may_share_ = false;                   ///< the present session was made so
  std::atomic<bool> shared_memory_ = false;  ///< the present stream has it

  std::mutex mutex_;  ///< of the two below; taken before that of the connection
  std::condition_variable wake_;
  std::unique_ptr<Connection> connection_;
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace holdfast::client
