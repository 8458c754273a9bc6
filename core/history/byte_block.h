#pragma once

#include <cstdint>

/// Eight bits a value with a common exponent, for statistics, whose own noise is far above what is
/// lost. A block's values are multiplied by the power of two that brings the greatest of them to
/// 1..2; a byte then counts steps down from 2, in the way of `ByteKind`. What is smaller than the
/// last becomes 0.
namespace holdfast {

inline constexpr int kByteBlock = 64;  ///< values

enum class ByteKind {
  kPlain,  ///< 8 steps an octave, over 31 octaves
  kFine,   ///< 32 steps an octave, over 7 octaves
};

/// Rounds as `pack_half_block` does, so that means of many values keep right.
struct BytePacking {
  const float* in;  ///< 0 .. 1e38
  int count;        ///< 1..kByteBlock
  ByteKind kind;
  const std::uint32_t* random;  ///< of draw_block_bits
  std::uint8_t* out;
  std::int8_t* exponent;  ///< written: of the power of two, -126..126
};
void pack_byte_block(const BytePacking& block) noexcept;

/// The values again.
struct ByteUnpacking {
  const std::uint8_t* in;
  int count;  ///< 1..kByteBlock
  ByteKind kind;
  std::int8_t exponent;
  float* out;
};
void unpack_byte_block(const ByteUnpacking& block) noexcept;

}  // namespace holdfast
