#include "core/denoiser/scratch_pool.h"

#include <algorithm>
#include <iterator>

namespace holdfast {

std::uint64_t ScratchPool::enter(std::size_t bytes) {
  const std::lock_guard lock(mutex_);
  needs_.insert(bytes);
  return ++entered_;
}

void ScratchPool::leave(std::size_t bytes) noexcept {
  const std::lock_guard lock(mutex_);
  needs_.erase(needs_.find(bytes));
  std::erase_if(idle_, [&](const Block& block) {
    if (block.bytes <= largest_need()) return false;
    count_out(block.bytes);
    return true;
  });
}

ScratchPool::Loan ScratchPool::borrow(std::size_t bytes, std::uint64_t images) {
  Block small;  // makes place for a larger one
  {
    const std::lock_guard lock(mutex_);
    const auto fit = std::find_if(idle_.rbegin(), idle_.rend(),
                                  [&](const Block& block) { return block.bytes >= bytes; });
    if (fit != idle_.rend()) {
      Loan loan(*this, std::move(*fit), images);
      idle_.erase(std::next(fit).base());
      return loan;
    }
    bytes = std::max(bytes, largest_need());
    idle_.reserve(blocks_ + 1);  // so that giving back cannot fail
    if (!idle_.empty()) {
      small = std::move(idle_.front());
      idle_.erase(idle_.begin());
      count_out(small.bytes);
    }
    ++blocks_;
    bytes_ += bytes;
  }
  small = {};
  try {
    return {*this, make_block(bytes), images};
  } catch (...) {
    const std::lock_guard lock(mutex_);
    count_out(bytes);
    throw;
  }
}

ScratchPool::Block ScratchPool::make_block(std::size_t bytes) {
  auto* data = static_cast<std::byte*>(
      ::operator new (std::max<std::size_t>(bytes, 1), std::align_val_t{64}));
  return {std::unique_ptr<std::byte, Free>(data), bytes, 0};
}

void ScratchPool::give_back(Block block) noexcept {
  const std::lock_guard lock(mutex_);
  if (block.bytes > largest_need())
    count_out(block.bytes);
  else
    idle_.push_back(std::move(block));
}

void ScratchPool::count_out(std::size_t bytes) noexcept {
  --blocks_;
  bytes_ -= bytes;
}

std::size_t ScratchPool::largest() const {
  const std::lock_guard lock(mutex_);
  return largest_need();
}

std::size_t ScratchPool::bytes() const {
  const std::lock_guard lock(mutex_);
  return bytes_;
}

}  // namespace holdfast
