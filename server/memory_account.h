#pragma once

#include <cstddef>
#include <set>

namespace holdfast::server {

/// What a session takes, bytes.
struct SessionBytes {
  std::size_t own = 0;      ///< history, frames in flight, answers, scratch of its stream
  std::size_t scratch = 0;  ///< that it borrows while a frame is filtered
};

/// The memory of all sessions. What is their own adds up. Scratch is shared: as many frames as are
/// filtered at once borrow, and each may be one of the session that needs the most. Not
/// thread-safe.
class MemoryAccount {
 public:
  /// `frames_at_once`: that are filtered at the same time, at most.
  explicit MemoryAccount(int frames_at_once)
      : frames_at_once_(static_cast<std::size_t>(frames_at_once)) {}

  void add(SessionBytes bytes) {
    own_ += bytes.own;
    scratch_.insert(bytes.scratch);
  }
  /// Takes out what was added.
  void remove(SessionBytes bytes) {
    own_ -= bytes.own;
    scratch_.erase(scratch_.find(bytes.scratch));
  }

  std::size_t own() const { return own_; }
  std::size_t scratch() const { return frames_at_once_ * largest(); }
  std::size_t total() const { return own() + scratch(); }
  /// What `total` would be after `add`.
  std::size_t total_with(SessionBytes more) const {
    return own_ + more.own +
           frames_at_once_ * (more.scratch > largest() ? more.scratch : largest());
  }

 private:
  std::size_t largest() const { return scratch_.empty() ? 0 : *scratch_.rbegin(); }

  const std::size_t frames_at_once_;
  std::size_t own_ = 0;
  std::multiset<std::size_t> scratch_;
};

}  // namespace holdfast::server
