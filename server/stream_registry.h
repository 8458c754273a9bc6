#pragma once

#include <chrono>
#include <condition_variable>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "server/session_life.h"

namespace holdfast::server {

class DenoiseStream;

/// The open streams, so that a shutdown can drain them and DeleteSession can close one.
class StreamRegistry {
 public:
  /// `most`: streams that may be open at once; `most_waiting`: of one peer network (peer.h) that
  /// have not said Hello, 0 = no limit.
  StreamRegistry(std::size_t most, std::size_t most_waiting)
      : most_(most), most_waiting_(most_waiting) {}

  /// Throws RefusedError, and the stream is not added, once `drain` was called (kDraining) or if
  /// too many are open (kLimit), or too many of its peer's wait for Hello.
  void add(const std::shared_ptr<DenoiseStream>& stream, const std::string& peer);
  /// The stream has said Hello.
  void greeted(const DenoiseStream* stream);
  void remove(const DenoiseStream* stream);
  /// Closes the streams of a session, if it has any.
  void close_session(const std::string& session_id);
  /// Ends the streams of a session whose holds are older than `hold`.
  void take_over(const std::string& session_id, SessionLife::Hold hold);
  /// Lets every stream look at the clock; see DenoiseStream::tick.
  void tick(std::chrono::steady_clock::time_point now);
  /// Asks every stream to finish the frames in flight and end; refuses new ones.
  void drain(std::chrono::milliseconds deadline);
  /// Waits until no stream is open; false if some are at the deadline.
  bool wait_empty(std::chrono::milliseconds deadline);
  std::size_t size() const;

 private:
  std::vector<std::shared_ptr<DenoiseStream>> all() const;

  struct Entry {
    std::weak_ptr<DenoiseStream> stream;
    std::string waiting;  ///< network of the peer until Hello; empty if it does not count
  };

  const std::size_t most_, most_waiting_;
  mutable std::mutex mutex_;
  std::condition_variable empty_;
  std::map<const DenoiseStream*, Entry> streams_;
  bool draining_ = false;
};

}  // namespace holdfast::server
