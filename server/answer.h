#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "core/denoiser/denoiser.h"

namespace holdfast::server {

/// Result planes whose memory waits to be used again.
class PlanePool {
 public:
  explicit PlanePool(std::size_t capacity) : capacity_(capacity) {}

  PlaneSet take();
  void give(PlaneSet&& planes);

 private:
  const std::size_t capacity_;
  std::mutex mutex_;
  std::vector<PlaneSet> spare_;
};

/// Why the history of a frame started anew.
enum class ResetReason { kNone, kFirst, kCut, kEpoch, kFailure };

/// What the filter made of one frame. Its planes go back to the pool when the last holder (the
/// stream that sends it, the ledger that remembers it) lets go.
class Answer {
 public:
  explicit Answer(std::shared_ptr<PlanePool> pool)
      : results(pool->take()), pool_(std::move(pool)) {}
  ~Answer() { pool_->give(std::move(results)); }
  Answer(const Answer&) = delete;
  Answer& operator=(const Answer&) = delete;

  std::uint64_t epoch = 0;
  FrameReport report;    ///< of a dropped frame, the index alone
  bool dropped = false;  ///< by the late-frame policy: no results
  ResetReason reset = ResetReason::kNone;
  PlaneSet results;

 private:
  const std::shared_ptr<PlanePool> pool_;
};

/// The last answers of a session, so that a frame that comes a second time, because its answer was
/// lost with a connection, is answered without being filtered again. Used by one thread at a time.
class AnswerLedger {
 public:
  /// `capacity`: answers remembered, at least the frames in flight.
  explicit AnswerLedger(std::size_t capacity);

  /// An empty answer, to be filled and then kept.
  std::shared_ptr<Answer> fresh() const { return std::make_shared<Answer>(pool_); }
  /// Remembers an answer; the oldest beyond the capacity is forgotten.
  void keep(std::shared_ptr<const Answer> answer);
  /// The answer to that frame; null if it is not remembered.
  std::shared_ptr<const Answer> find(std::uint64_t epoch, std::int64_t index) const;

 private:
  const std::size_t capacity_;
  const std::shared_ptr<PlanePool> pool_;
  std::vector<std::shared_ptr<const Answer>> kept_;  ///< oldest first
};

}  // namespace holdfast::server
