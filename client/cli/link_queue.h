#pragma once

#include <chrono>
#include <cstddef>
#include <deque>
#include <vector>

namespace holdfast::cli {

/// One direction of a link: bytes that went in come out after the delay, in order, no faster than
/// the rate. Knows neither sockets nor clock: the time is handed in.
class LinkQueue {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;
  using Duration = std::chrono::steady_clock::duration;

  /// `delay_s`: seconds. `bytes_per_s`: 0 = no limit.
  LinkQueue(double delay_s, double bytes_per_s);

  /// Bytes that may be put in now; 0 while the link is full.
  std::size_t room() const { return held_ < capacity_ ? capacity_ - held_ : 0; }
  void put(const char* data, std::size_t size, TimePoint now);
  bool empty() const { return pieces_.empty(); }
  /// When the first bytes may come out. Not for an empty queue.
  TimePoint due() const;
  /// The bytes that may come out first, and their number; they stay until `drop`.
  const char* data() const { return pieces_.front().bytes.data() + taken_; }
  std::size_t size() const { return pieces_.front().bytes.size() - taken_; }
  /// That many of `size` have come out.
  void drop(std::size_t count, TimePoint now);

 private:
  struct Piece {
    TimePoint due;
    std::vector<char> bytes;
  };
  const Duration delay_;
  const double bytes_per_s_;
  const std::size_t capacity_;
  std::deque<Piece> pieces_;
  std::size_t held_ = 0, taken_ = 0;  ///< bytes in all; bytes of the first piece that are out
  TimePoint free_{};                  ///< when the link has carried what has come out
};

}  // namespace holdfast::cli
