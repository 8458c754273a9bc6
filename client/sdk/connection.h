#pragma once

#include <condition_variable>
#include <mutex>
#include <optional>
#include <thread>

#include <grpcpp/client_context.h>
#include <grpcpp/generic/generic_stub.h>
#include <grpcpp/support/client_callback.h>
#include <holdfast/client.h>

#include "client/sdk/exchange.h"
#include "client/sdk/frame_sender.h"
#include "client/sdk/result_assembler.h"
#include "holdfast/v1/denoise_service.pb.h"
#include "proto/shared_cells.h"

namespace holdfast::client {

/// One Denoise stream of a session: carries frames from the exchange and answers into it, from
/// Hello to its end, which comes when all is answered after `finish` or when the connection is
/// lost. Reactions of gRPC and calls of the owner run on different threads; one mutex guards
/// everything, taken before that of the exchange. A read is always under way until the stream ends,
/// and a hold keeps the stream valid for writes from other threads until then.
///
/// Planes are encoded on a thread of the connection, one message ahead of the one being written, so
/// that neither gRPC nor the user's thread waits for a codec. Profile `exact`, which only copies,
/// needs none: its messages are made where they are written. Results are decoded where they come
/// in: that is several times cheaper.
class Connection final : public grpc::ClientBidiReactor<grpc::ByteBuffer, grpc::ByteBuffer> {
 public:
  /// What the stream has to know about its session.
  struct Config {
    std::vector<PlaneId> planes, results;
    const wire::WireProfile* wire = &wire::exact_profile();
    bool fresh = false;  ///< the session was made for this stream
    std::shared_ptr<wire::SharedMemory> shared_memory = nullptr;  ///< that Hello names
  };

  /// Starts the stream.
  Connection(grpc::GenericStub& stub, Exchange& exchange, Config config, const v1::Hello& hello);
  /// Cancels the stream if it is open, and waits for its end.
  ~Connection() override;

  /// Waits for Welcome. If none comes in time or the stream ends, it has ended with the status
  /// returned.
  grpc::Status wait_open(std::chrono::milliseconds timeout);
  /// Waits for the end of the stream, which follows a failed write within a second or is brought
  /// about then; returns its status.
  grpc::Status wait_end();
  /// The exchange has something new to send.
  void pump();
  void cancel();
  /// Planes go through shared memory; known once the stream is open.
  bool shared_memory() const;

  void OnReadDone(bool ok) override;
  void OnWriteDone(bool ok) override;
  void OnDone(const grpc::Status& status) override;

 private:
  // All of these are called with the mutex held.
  void handle_message();
  void handle_response();
  void add(wire::ChunkView& chunk);
  bool write_read_cells();
  void write_on();
  bool next_message(wire::OutgoingMessage& message, std::unique_lock<std::mutex>* lock);
  void start_write();
  void end_writes();

  void encode();

  Exchange& exchange_;
  const Config config_;
  grpc::ClientContext context_;
  mutable std::mutex mutex_;
  mutable std::condition_variable changed_;
  std::optional<wire::SharedCells> cells_;   ///< if there is shared memory
  std::optional<std::uint64_t> read_cells_;  ///< to be told to the server
  PlaneWriter writer_;                       ///< of the sender
  std::optional<FrameSender> sender_;        ///< of the encoding thread, if there is one
  ResultAssembler assembler_;
  grpc::ByteBuffer request_, received_;
  wire::ChunkReader chunks_;
  v1::DenoiseResponse response_;  ///< what was received, unless it is a chunk
  bool welcome_ = false, writing_ = false, writes_done_ = false;
  bool ended_ = false;                  ///< no more reads or writes may be started
  bool write_failed_ = false;           ///< as is told of a stream that has ended
  std::optional<grpc::Status> status_;  ///< after OnDone
  std::string violation_;               ///< how the server broke the protocol

  // Of the encoding thread.
  std::condition_variable wake_;
  wire::OutgoingMessage prepared_;
  bool has_prepared_ = false;
  bool woken_ = false;  ///< there may be something to encode
  std::thread encoder_;
};

}  // namespace holdfast::client
