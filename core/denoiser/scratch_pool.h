#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <new>
#include <set>
#include <utility>
#include <vector>

namespace holdfast {

/// Memory that denoisers need only while they filter a frame, for all that share the pool: a block
/// for each frame that is filtered at once, as large as the neediest of the denoisers asks for. So
/// any block serves any of them, whatever their sizes and recipes, and none is allocated any more
/// once as many frames as ever were filtered at once. What is in a block when it is lent is
/// undefined. Every function may be called from any thread.
class ScratchPool {
  struct Free {
    void operator()(std::byte* p) const { ::operator delete (p, std::align_val_t{64}); }
  };
  struct Block {
    std::unique_ptr<std::byte, Free> data;
    std::size_t bytes = 0;
    std::uint64_t images = 0;  ///< those that it was divided among last; 0: none
  };

 public:
  /// A block, for as long as this lives. It must not outlive the pool.
  class Loan {
   public:
    Loan(Loan&& other) noexcept = default;
    Loan& operator=(Loan&&) = delete;
    ~Loan() {
      if (block_.data) pool_.give_back(std::move(block_));
    }
    std::byte* data() const { return block_.data.get(); }  ///< aligned to cache lines
    std::size_t bytes() const { return block_.bytes; }
    /// Whether nobody but the same images has had it since it was new.
    bool is_as_left() const { return is_as_left_; }

   private:
    friend class ScratchPool;
    Loan(ScratchPool& pool, Block block, std::uint64_t images)
        : pool_(pool),
          block_(std::move(block)),
          is_as_left_(images != 0 && block_.images == images) {
      block_.images = images;
    }
    ScratchPool& pool_;
    Block block_;
    bool is_as_left_;
  };

  /// There is a denoiser that will borrow so much at a time. Returns a number for the images that
  /// it will divide that among, never the same one.
  std::uint64_t enter(std::size_t bytes);
  /// It is gone. Blocks that are larger than any of the others needs are freed.
  void leave(std::size_t bytes) noexcept;

  /// A block of at least so many bytes: of those that fit the one that was given back last, which
  /// is the likeliest to be in a cache. `images`: as `enter` gave, or 0 for whatever it is used
  /// for. Throws std::bad_alloc; nothing has changed then.
  Loan borrow(std::size_t bytes, std::uint64_t images = 0);

  /// What the neediest denoiser needs.
  std::size_t largest() const;
  /// Held, lent or not: at most `largest` for each frame that was filtered at once.
  std::size_t bytes() const;

 private:
  static Block make_block(std::size_t bytes);
  void give_back(Block block) noexcept;
  std::size_t largest_need() const { return needs_.empty() ? 0 : *needs_.rbegin(); }
  void count_out(std::size_t bytes) noexcept;

  mutable std::mutex mutex_;
  std::multiset<std::size_t> needs_;
  std::vector<Block> idle_;             ///< in the order in which they were given back
  std::size_t blocks_ = 0, bytes_ = 0;  ///< idle or lent
  std::uint64_t entered_ = 0;
};

}  // namespace holdfast
