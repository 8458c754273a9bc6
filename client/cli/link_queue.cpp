#include "client/cli/link_queue.h"

#include <algorithm>

namespace holdfast::cli {
namespace {

constexpr double kSpare = 256 << 10;      // bytes in a queue beyond those under way
constexpr double kUnlimited = 64u << 20;  // bytes under way where there is no limit on the rate
constexpr std::size_t kPiece = 16 << 10;  // small against what a link carries in a millisecond

LinkQueue::Duration duration(double seconds) {
  return std::chrono::duration_cast<LinkQueue::Duration>(std::chrono::duration<double>(seconds));
}

}  // namespace

LinkQueue::LinkQueue(double delay_s, double bytes_per_s)
    : delay_(duration(delay_s)),
      bytes_per_s_(bytes_per_s),
      capacity_(static_cast<std::size_t>(
          kSpare + (bytes_per_s > 0 ? std::min(bytes_per_s * delay_s, kUnlimited) : kUnlimited))) {}

void LinkQueue::put(const char* data, std::size_t size, TimePoint now) {
  held_ += size;
  for (; size > 0; data += std::min(size, kPiece), size -= std::min(size, kPiece))
    pieces_.push_back({now + delay_, {data, data + std::min(size, kPiece)}});
}

LinkQueue::TimePoint LinkQueue::due() const { return std::max(pieces_.front().due, free_); }

void LinkQueue::drop(std::size_t count, TimePoint now) {
  held_ -= count;
  taken_ += count;
  if (bytes_per_s_ > 0)
    free_ = std::max(free_, now) + duration(static_cast<double>(count) / bytes_per_s_);
  if (taken_ < pieces_.front().bytes.size()) return;
  pieces_.pop_front();
  taken_ = 0;
}

}  // namespace holdfast::cli
