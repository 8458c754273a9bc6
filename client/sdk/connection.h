#pragma once

#include <condition_variable>
#include <deque>
#include <mutex>
#include <optional>

#include <grpcpp/client_context.h>
#include <grpcpp/support/client_callback.h>
#include <holdfast/client.h>

#include "client/sdk/frame_sender.h"
#include "client/sdk/result_assembler.h"
#include "holdfast/v1/denoise_service.grpc.pb.h"

namespace holdfast::client {

/// The Denoise stream of one session. Reactions of gRPC and calls of the user run on different
/// threads; one mutex guards everything. A read is always under way until the stream ends, and a
/// hold keeps the stream valid for writes from user threads until then.
class Connection final : public grpc::ClientBidiReactor<v1::DenoiseRequest, v1::DenoiseResponse> {
 public:
  /// What the stream has to know about its session.
  struct Config {
    std::string address;
    std::vector<PlaneId> planes, results;
    int width = 0, height = 0;
  };

  /// Opens the stream and waits for Welcome. Throws as Session's constructor.
  Connection(v1::DenoiseService::Stub& stub, Config config, const v1::Hello& hello,
             std::chrono::milliseconds timeout);
  /// Cancels the stream if it is open, and waits for its end.
  ~Connection() override;

  /// False if there is no credit and `wait` is false.
  bool submit(std::shared_ptr<const Frame> frame, bool wait);
  std::optional<FrameOutput> receive(bool wait);
  void finish();
  /// Waits for the end of the stream; returns its status.
  grpc::Status wait_end();
  void recycle(PlaneSet&& planes);

  int credits() const;
  int in_flight() const;
  Traffic traffic() const;

  void OnReadDone(bool ok) override;
  void OnWriteDone(bool ok) override;
  void OnDone(const grpc::Status& status) override;

 private:
  struct Pending {
    std::int64_t index;
    std::chrono::steady_clock::time_point submitted;
  };

  // All of these are called with the mutex held.
  void handle_response();
  void complete();
  void write_on();
  [[noreturn]] void throw_ended() const;

  const Config config_;
  grpc::ClientContext context_;
  mutable std::mutex mutex_;
  mutable std::condition_variable changed_;
  std::deque<std::shared_ptr<const Frame>> unsent_;
  std::deque<Pending> pending_;  ///< submitted, not yet answered
  std::optional<FrameSender> sender_;
  ResultAssembler assembler_;
  std::deque<FrameOutput> outputs_;
  std::vector<PlaneSet> spare_;
  Traffic traffic_;
  v1::DenoiseRequest request_;
  v1::DenoiseResponse response_;
  int credits_ = 0;
  bool welcome_ = false, writing_ = false, finishing_ = false, writes_done_ = false;
  bool ended_ = false;                  ///< no more reads or writes may be started
  std::optional<grpc::Status> status_;  ///< after OnDone
  std::string violation_;               ///< how the server broke the protocol
};

}  // namespace holdfast::client
