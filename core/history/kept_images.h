#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "core/frame/plane.h"

namespace holdfast {

/// How a history is kept from frame to frame.
enum class HistoryFormat {
  kNone,    ///< not at all: nothing of a frame reaches the next
  kPacked,  ///< every channel in as few bits as it needs: `KeptAs`
  kFloat,   ///< as floats
};

/// What a channel takes when packed.
enum class KeptAs {
  kHalf,      ///< two bytes: half_block.h
  kByte,      ///< one byte, of values that are not negative: byte_block.h
  kFineByte,  ///< likewise, in finer steps over a shorter range
};

/// The images that a history keeps. They are floats while a frame is filtered, in rooms that many
/// histories can share, one after the other.
class KeptImages {
 public:
  KeptImages() = default;
  KeptImages(int width, int height, std::vector<KeptAs> channels, HistoryFormat format);

  HistoryFormat format() const { return format_; }
  std::size_t bytes() const {
    return whole_.bytes() + halves_.bytes() + bytes_.bytes() + exponents_.bytes();
  }

  /// What is done to row y of images of floats, after they were unpacked or before they are packed.
  using RowStep = std::function<void(Channels<float>& images, int y)>;

  /// Brings what was kept into `room`. What is packed needs a room of its size; floats change
  /// places with the room, which may be empty, and are not kept here until `keep`.
  void recall(Channels<float>& room, const RowStep& unpacked = {});

  /// Keeps `now`, which is left with images of the same size, or, of floats, with none if `recall`
  /// took them away. `key`: what rounding depends on, another one for every frame. All
  /// channels of a pixel are rounded by the same number: equal values stay equal, grey stays grey.
  void keep(Channels<float>& now, std::uint64_t key, const RowStep& packing = {});

  /// What is kept, if as floats; else empty.
  const Channels<float>& floats() const { return whole_; }
  /// A copy of what is kept.
  Channels<float> copy() const;

 private:
  void unpack_row(int y, Channels<float>& room) const;
  void pack_row(int y, const Channels<float>& now, std::uint64_t key);
  int blocks() const { return (width_ + kBlock - 1) / kBlock; }

  static constexpr int kBlock = 64;  ///< pixels of a row that share an exponent, by channel

  HistoryFormat format_ = HistoryFormat::kNone;
  int width_ = 0, height_ = 0;
  std::vector<KeptAs> channels_;
  Channels<float> whole_;
  Channels<std::uint16_t> halves_;   ///< of the channels that are kept so, in their order
  Channels<std::uint8_t> bytes_;     ///< likewise
  Channels<std::int8_t> exponents_;  ///< one row for each row, of all channels, block by block
};

}  // namespace holdfast
