#pragma once

#include <chrono>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <grpcpp/support/server_callback.h>

#include "holdfast/v1/denoise_service.pb.h"
#include "proto/shared_cells.h"
#include "server/answer_writer.h"
#include "server/frame_assembler.h"
#include "server/service_state.h"
#include "server/stream_deadlines.h"

namespace holdfast::server {

/// One Denoise stream: reads messages into frames, hands frames to the worker pool, sends results.
///
///   read Hello -> Welcome
///   read FrameBegin -> takes a free slot; if there is none, reading stops until one is free, and
///                      HTTP/2 flow control stops the client: that is the backpressure
///   read chunks, FrameEnd -> the slot joins the session's strand (also if it has an error, so that
///                      answers keep the order of the frames)
///   job done -> the slot joins the sending queue; when its last message is written it is free
///
/// Reactions and jobs run on different threads; one mutex guards everything. The reactor keeps
/// itself alive until OnDone, jobs keep it alive while they run. Finish is called when no slot is
/// in use and nothing is being written.
class DenoiseStream final : public grpc::ServerBidiReactor<grpc::ByteBuffer, grpc::ByteBuffer>,
                            public std::enable_shared_from_this<DenoiseStream> {
 public:
  /// Makes the stream and starts it.
  /// `peer`: address of its client, as gRPC writes it.
  static DenoiseStream* start(ServiceState& state, const std::string& peer);

  /// Announces the shutdown, answers the frames in flight, then ends the stream.
  void drain(std::chrono::milliseconds deadline);
  /// Ends the stream with `status` once the frames in flight are answered, also one whose chunks
  /// are still coming in; later frames are not accepted.
  void close(const grpc::Status& status);
  /// Ends the stream if `hold` on its session is newer than its own: what is in flight is dropped.
  void yield(SessionLife::Hold hold);
  /// Ends the stream if its client is silent or slow beyond the limits, and reads on where it was
  /// held up for a limit on rates; called from time to time.
  void tick(StreamDeadlines::TimePoint now);
  /// Empty before Hello.
  std::string session_id() const;

  void OnReadDone(bool ok) override;
  void OnWriteDone(bool ok) override;
  void OnCancel() override;
  void OnDone() override;

 private:
  explicit DenoiseStream(ServiceState& state)
      : state_(state),
        deadlines_(state.config.hello_timeout, state.config.frame_timeout,
                   StreamDeadlines::TimePoint::clock::now()) {}

  // All of these are called with the mutex held.
  bool handle_message();
  bool handle_request();
  void handle_hello(const v1::Hello& hello);
  /// True while messages of the client are read, or will be without more of ours.
  bool hears() const { return !stalled_ && !read_due_ && !read_all_ && !broken_; }
  bool handle_frame_begin(const v1::FrameBegin& begin);
  FrameSlot* free_slot();
  void begin_frame(const v1::FrameBegin& begin, FrameSlot& slot);
  void hold_reading(SessionRates::Duration time);
  void begin_stalled();
  void post(FrameSlot& slot);
  void read_on();
  void write_on();
  const wire::OutgoingMessage* next_message();
  void release(FrameSlot& slot);
  void drop_unsent();
  void decode(wire::ChunkView& chunk);
  void attach_cells(const v1::Hello& hello);
  void note_read(const v1::SharedRead& read);
  void discard_cells();
  void refuse(std::exception_ptr error);
  void end(const grpc::Status& status);
  [[nodiscard]] bool ready_to_finish();

  /// The job of one frame; runs on the worker pool.
  void filter(FrameSlot& slot);
  /// Makes the next message; runs on the encoders.
  void encode();
  /// Takes the mutex off and calls Finish if everything is done.
  void unlock_and_finish(std::unique_lock<std::mutex>& lock);
  void log_frame(const FrameSlot& slot) const;
  void show_frame(const FrameSlot& slot) const;

  ServiceState& state_;
  std::shared_ptr<DenoiseStream> self_;

  mutable std::mutex mutex_;
  StreamDeadlines deadlines_;
  std::shared_ptr<Session> session_;
  SessionLife::Hold hold_ = 0;                   ///< on session_
  std::shared_ptr<const SessionConfig> config_;  ///< of the frame that came last
  bool heir_ = false;                            ///< an older stream of the session has to be ended
  std::shared_ptr<SessionWatch> watch_;
  std::shared_ptr<SessionRates> rates_;
  std::optional<SessionRates::TimePoint> read_due_;  ///< nothing is read before, for `rates_`
  std::optional<FrameAssembler> assembler_;
  FrameSlot* open_ = nullptr;  ///< of the frame that the assembler has open
  std::vector<std::unique_ptr<FrameSlot>> slots_;
  std::vector<FrameSlot*> free_;
  std::vector<PlaneSet> planes_;            ///< of frames that were filtered, for those that come
  std::optional<wire::SharedCells> cells_;  ///< if the client has shared memory
  std::size_t shared_bytes_ = 0;            ///< that came there with the message at hand
  AnswerWriter writer_;
  grpc::ByteBuffer received_;
  wire::ChunkReader chunks_;
  v1::DenoiseRequest request_;  ///< what was received, unless it is a chunk
  int waiting_ = 0;             ///< whole good frames that wait to be filtered
  bool reading_ = false;        ///< a read is under way
  bool stalled_ = false;   ///< request_ holds a FrameBegin that waits for a slot or for its turn
  bool writing_ = false;   ///< a message is being encoded or written
  bool read_all_ = false;  ///< the client has ended its side, or nothing more is to be read
  bool closing_ = false;   ///< ends after the frame that is being read
  bool broken_ = false;    ///< cancelled or disconnected: nothing can be sent
  bool finished_ = false;  ///< Finish was called
  grpc::Status status_;
};

}  // namespace holdfast::server
