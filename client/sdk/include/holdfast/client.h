#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/frame/error.h"
#include "core/frame/frame.h"

/// The client library: a session on a Holdfast server, into which a renderer streams noisy frames
/// and from which it receives clean ones.
namespace holdfast::client {

/// The server cannot be reached, or the connection was lost for longer than the session waits.
struct ConnectionError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The server was reached and refuses: a limit, a shutdown, a session that it does not know.
struct RefusedError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Files in PEM form for an encrypted connection.
struct TlsFiles {
  std::string ca;  ///< authorities that the server's certificate must come from; empty = no TLS
  std::string certificate;  ///< our own, if the server asks for one
  std::string key;          ///< of that
  /// Name that the server's certificate must have; empty = the host of the address. For servers
  /// behind a tunnel or a relay.
  std::string server_name;
};

/// What a server does with a frame that waits to be filtered when a newer one has come.
enum class LateFrames {
  kAll,     ///< it is filtered
  kLatest,  ///< it is dropped: answered without planes, and the next one goes on from the one
            ///< before
};

/// What is fixed for the life of a session.
struct SessionOptions {
  std::string address = "127.0.0.1:50051";  ///< host:port or unix:PATH
  std::chrono::milliseconds connect_timeout{5000};
  /// A lost connection is opened again for that long; 0 = never.
  std::chrono::milliseconds reconnect_timeout{10000};
  /// Answered frames that the session holds, to warm the history of a new server with them if the
  /// old one is lost; 0 = none.
  int rewarm_frames = 4;
  /// Path of the server's side socket for shared memory (holdfast-server --shared-memory), for a
  /// server on the same machine and of the same user: planes then go through memory that both map.
  /// Empty = none. Where none is to be had all goes through the stream; see Session::shared_memory.
  std::string shared_memory;
  TlsFiles tls;
  std::string bearer_token;  ///< with which the server admits us; empty = none

  int width = 0;                ///< pixels, 1..kMaxDimension
  int height = 0;               ///< pixels, 1..kMaxDimension
  std::vector<Light> lights;    ///< each id at most once
  std::vector<PlaneId> planes;  ///< exactly what every frame brings; depth and normal at least
  std::string recipe;           ///< empty = the server's default
  std::string preset;           ///< empty = the server's default
  std::string indirect_basis;   ///< "irradiance", "luminance-cones", "cones"; empty = the preset's
  std::vector<std::string> half_resolution;  ///< of "indirect", "glossy", "visibility", or "none";
                                             ///< empty = the preset's
  std::string history;                       ///< "f16" or "f32"; empty = the preset's
  std::uint64_t seed = 0;                    ///< the same seed gives the same bits
  bool debug_planes = false;  ///< also motion, history and confidence of each component
  double budget_ms = 0;       ///< wished time of a frame in the core, for which faster presets than
                              ///< `preset` may be used; 0 = none
  /// Frames that will be sent a second; 0 = not told. A server that has not so much time left
  /// refuses the session (RefusedError), and reads it no faster than that.
  double frames_per_second = 0;
  std::string wire = "exact";    ///< name of the wire profile
  std::vector<PlaneId> results;  ///< result planes to send back; empty = all
  LateFrames late_frames = LateFrames::kAll;
  /// Filtering of a frame should begin that long after it has begun to arrive, milliseconds; one
  /// that is later is marked, and dropped under LateFrames::kLatest. 0 = no deadline.
  double frame_deadline_ms = 0;
};

/// Another size, recipe or preset in mid-session; 0 and empty = as before. History comes along.
struct SessionChange {
  int width = 0;   ///< pixels, 1..kMaxDimension
  int height = 0;  ///< pixels, 1..kMaxDimension
  std::string recipe;
  std::string preset;
};

/// Where the time of a frame went, milliseconds. All but `total` by the server's clock.
struct FrameTiming {
  struct Stage {
    std::string name;
    double ms = 0;
  };
  double receive = 0;         ///< from the frame's first message to its last, at the server
  double wait = 0;            ///< from then to the start of filtering
  double core = 0;            ///< inside the denoiser
  std::vector<Stage> stages;  ///< parts of core
  double total = 0;           ///< from submit to the last byte of the results, by our clock
};

/// Why a frame has no results. Later frames are not affected.
struct FrameFailure {
  std::string message;
  std::optional<InputError> input;  ///< the rule that the frame broke; nothing if the server failed
  bool refused =
      false;  ///< it came under a change (Session::change) that the server has no room for
};

/// The answer to one frame.
struct FrameOutput {
  struct Repair {
    std::string plane;
    std::uint64_t values = 0;
  };
  std::int64_t index = 0;
  std::optional<FrameFailure> error;  ///< then `planes` is empty
  PlaneSet planes;                    ///< the results
  FrameTiming timing;
  bool history_reset = false;
  double mean_history_frames = 0;  ///< over surface pixels and components
  std::string preset;              ///< that was used; empty with an error, or if dropped
  std::vector<Repair> repaired;    ///< values that were not finite or out of range, by plane
  std::uint64_t non_finite_out = 0;
  bool history_lost = false;  ///< the server was lost: history was made anew from the last frames
  bool dropped = false;       ///< by LateFrames::kLatest; then `planes` is empty
  bool repeated = false;      ///< the frame was sent again, and its answer was still known
  bool deadline_passed = false;  ///< before it could be filtered; see SessionOptions
};

/// Plane bytes that crossed the wire, or went through shared memory.
struct Traffic {
  std::uint64_t sent = 0;
  std::uint64_t received = 0;
};

/// Has gRPC wait for the sockets of this process's sessions with one thread in place of two, while
/// there are any: over TCP they are nearly half as fast again. With more than five processors,
/// where gRPC has more threads, it changes nothing. For the main function of a program; callbacks
/// of its own gRPC calls, if it has any, must not block then.
void prefer_one_poller();

/// A session and its stream. Frames are answered in the order in which they were submitted. One
/// thread may submit while another receives.
///
/// A lost connection is opened again in the background: what was not answered is sent again, and no
/// frame is filtered twice or left out. If the server has lost the session, a new one is made and
/// warmed with the last answered frames; the next output says so (`history_lost`).
class Session {
 public:
  /// Connects, makes the session, opens the stream. Throws ConnectionError, RefusedError, or
  /// InputError naming what is wrong with the options.
  explicit Session(const SessionOptions& options);
  /// Ends the session at once; what is in flight is lost.
  ~Session();
  Session(Session&&) noexcept;
  Session& operator=(Session&&) noexcept;

  /// Sends a frame; blocks while as many frames are in flight as the server gave credits. The
  /// planes are read until the session lets go of the pointer, which is rewarm_frames answers after
  /// the frame's own, or once the connection is gone: they must not change before. A pointer that
  /// owns nothing is for frames that outlive the session and are all answered. Throws InputError if
  /// the planes are not those of the session; the session is then as before. Throws ConnectionError
  /// or RefusedError if the stream has ended.
  void submit(std::shared_ptr<const Frame> frame);
  void submit(Frame&& frame);
  /// The same, but returns false at once where `submit` would block.
  bool try_submit(std::shared_ptr<const Frame> frame);

  /// The next answer; waits for it. Nothing once all frames are answered after `finish`. Answers
  /// are kept until they are received: whoever submits without receiving fills the memory. Throws
  /// ConnectionError or RefusedError if the stream ended before all was answered.
  std::optional<FrameOutput> receive();
  /// The same, but returns nothing at once if there is no answer yet.
  std::optional<FrameOutput> try_receive();

  /// The frames that follow belong together: history starts anew and indices may start again.
  void restart();

  /// Frames submitted from now on are of that size, and are filtered by that recipe and preset.
  /// What is in flight is not affected. A server that refuses says so with each frame that comes
  /// under the change (FrameOutput::error); nothing is lost, and another `change` may take it back.
  /// Throws InputError for a size out of range.
  void change(const SessionChange& change);

  /// No more frames will be submitted.
  void finish();
  /// Ends the session in order: finishes, waits for what is in flight, deletes it on the server.
  void close();

  /// Gives result planes back, so that later results reuse their memory. Optional.
  void recycle(PlaneSet&& planes);

  /// Frames that may be in flight.
  int credits() const;
  /// Frames submitted and not yet answered.
  int in_flight() const;
  /// How often a lost connection was opened again.
  int reconnects() const;
  /// Result planes of each frame, in order. These and the next two are as the session was made.
  const std::vector<PlaneId>& results() const;
  const std::string& recipe() const;
  const std::string& preset() const;
  Traffic traffic() const;
  /// Planes go through shared memory at present.
  bool shared_memory() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace holdfast::client
