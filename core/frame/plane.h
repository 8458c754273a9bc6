#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <list>
#include <memory>
#include <new>
#include <span>
#include <vector>

#include "core/frame/plane_id.h"

namespace holdfast {

/// A view of one channel: `height` rows of `width` values, `stride` values apart.
template <class T>
struct ChannelView {
  T* data = nullptr;
  int width = 0;
  int height = 0;
  std::ptrdiff_t stride = 0;  ///< in values, >= width; 0: all rows are one

  T* row(int y) const { return data + y * stride; }
  T& at(int x, int y) const { return data[y * stride + x]; }
  explicit operator bool() const { return data != nullptr; }
  operator ChannelView<const T>() const { return {data, width, height, stride}; }
};

/// Values beside each row of an image of `Channels` that are 0 where its stride leaves room for so
/// many, so that taps a little outside need no test: after the row, and before the first one.
/// Nobody writes there.
inline constexpr std::ptrdiff_t kApron = 16;

/// Values between the starts of two rows: rows begin on cache lines, and no stride is a multiple of
/// 4096 bytes, which would map every row to the same cache sets. Rows of 256 values and more have
/// an apron.
std::ptrdiff_t padded_stride(int width);

/// Whose memory images lie in.
enum class Memory {
  kOwned,  ///< their own, zero-initialised
  kLent,   ///< given by `lend`; there is none before, and it holds anything
};

/// Memory aligned to cache lines.
class AlignedBuffer {
 public:
  AlignedBuffer() = default;
  explicit AlignedBuffer(std::size_t bytes, Memory memory = Memory::kOwned);
  std::byte* data() const { return data_.get(); }
  std::size_t size() const { return size_; }
  Memory memory() const { return data_.get_deleter().memory; }
  /// Memory for `size()` bytes, aligned as its own would be; null takes it back. Of lent ones only.
  void lend(std::byte* data) {
    assert(memory() == Memory::kLent);
    data_.reset(data);
  }

 private:
  struct Free {
    Memory memory;
    Free() : memory(Memory::kOwned) {}
    explicit Free(Memory m) : memory(m) {}
    void operator()(std::byte* p) const {
      if (memory == Memory::kOwned) ::operator delete (p, std::align_val_t{64});
    }
  };
  std::unique_ptr<std::byte, Free> data_;
  std::size_t size_ = 0;
};

/// `channels` images of one size in one allocation; scratch and history of the core.
template <class T>
class Channels {
 public:
  Channels() = default;
  Channels(int width, int height, int channels, Memory memory = Memory::kOwned)
      : width_(width),
        height_(height),
        count_(channels),
        stride_(padded_stride(width)),
        buffer_(static_cast<std::size_t>(kBefore + stride_ * height * channels) * sizeof(T),
                memory) {}

  int width() const { return width_; }
  int height() const { return height_; }
  int count() const { return count_; }
  std::size_t bytes() const { return buffer_.size(); }
  Memory memory() const { return buffer_.memory(); }
  void lend(std::byte* data) { buffer_.lend(data); }
  /// Makes the apron of an image that was lent memory which may hold anything.
  void clear_apron() {
    if (stride_ - width_ < kApron) return;
    std::fill_n(base() - kBefore, kBefore, T{});
    for (std::ptrdiff_t y = 0; y < std::ptrdiff_t{height_} * count_; ++y)
      std::fill_n(base() + y * stride_ + width_, stride_ - width_, T{});
  }
  explicit operator bool() const { return count_ > 0; }

  ChannelView<T> operator[](int c) {
    return {base() + c * stride_ * height_, width_, height_, stride_};
  }
  ChannelView<const T> operator[](int c) const {
    return {base() + c * stride_ * height_, width_, height_, stride_};
  }

 private:
  static constexpr std::ptrdiff_t kBefore = 64 / sizeof(T);  ///< a cache line, >= kApron of words

  T* base() const {
    return buffer_.data() == nullptr ? nullptr : reinterpret_cast<T*>(buffer_.data()) + kBefore;
  }

  int width_ = 0, height_ = 0, count_ = 0;
  std::ptrdiff_t stride_ = 0;
  AlignedBuffer buffer_;
};

/// One named plane with all its channels. Float and uint planes share the storage type of 4 bytes.
class Plane {
 public:
  Plane() = default;
  /// A plane, zero-filled if its memory is its own. Throws InputError unless 1 <= width, height <=
  /// kMaxDimension.
  Plane(PlaneId id, int width, int height, Memory memory = Memory::kOwned);

  PlaneId id() const { return id_; }
  int width() const { return width_; }
  int height() const { return height_; }
  int channels() const { return channel_count(id_.kind); }
  std::size_t bytes() const { return storage_.bytes(); }
  Memory memory() const { return storage_.memory(); }
  void lend(std::byte* data) { storage_.lend(data); }
  void clear_apron() { storage_.clear_apron(); }
  bool is_uint() const { return plane_traits(id_.kind).scalar == ScalarType::kUint; }

  /// Channel of a float plane; asserts the type.
  ChannelView<float> channel(int c);
  ChannelView<const float> channel(int c) const;
  /// The only channel of a uint plane; asserts the type.
  ChannelView<std::uint32_t> ids();
  ChannelView<const std::uint32_t> ids() const;
  /// Any channel as raw 4-byte words, for copying.
  ChannelView<std::uint32_t> words(int c);
  ChannelView<const std::uint32_t> words(int c) const;

 private:
  PlaneId id_{};
  int width_ = 0, height_ = 0;
  Channels<std::uint32_t> storage_;
};

/// Largest width or height of a frame, in pixels.
inline constexpr int kMaxDimension = 16384;

/// A set of planes, each identity at most once.
class PlaneSet {
 public:
  /// The plane, or null.
  const Plane* find(PlaneId id) const;
  Plane* find(PlaneId id);
  /// The plane; throws InputError naming it if it is missing.
  const Plane& at(PlaneId id) const;
  /// Adds a plane, or returns the one that is there if the size agrees (else replaces it).
  /// References to other planes stay valid.
  Plane& add(PlaneId id, int width, int height, Memory memory = Memory::kOwned);
  void remove(PlaneId id);
  void clear() { planes_.clear(); }

  std::size_t size() const { return planes_.size(); }
  auto begin() const { return planes_.begin(); }
  auto end() const { return planes_.end(); }
  auto begin() { return planes_.begin(); }
  auto end() { return planes_.end(); }

 private:
  std::list<Plane> planes_;  // so that adding one leaves references to others valid
};

}  // namespace holdfast
