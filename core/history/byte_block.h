#pragma once

#include <cstdint>

/// Eight bits a value with a common exponent, for statistics, whose own noise is far above what is
/// lost. A block's values are multiplied by the power of two that brings the greatest of them to
/// 1..2; a byte is then an exponent and a mantissa of three bits (steps of 6 to 12 %), over 31
/// octaves below the greatest, or 15 and a sign. What is smaller becomes 0.
namespace holdfast {

inline constexpr int kByteBlock = 64;  ///< values

/// Rounds as `pack_half_block` does, so that means of many values keep right.
struct BytePacking {
  const float* in;  ///< finite, absolute values below 1e38; not negative unless `with_sign`
  int count;        ///< 1..kByteBlock
  bool with_sign;
  const std::uint32_t* random;  ///< of draw_block_bits
  std::uint8_t* out;
  std::int8_t* exponent;  ///< written: of the power of two, -126..126
};
void pack_byte_block(const BytePacking& block) noexcept;

/// The values again.
struct ByteUnpacking {
  const std::uint8_t* in;
  int count;  ///< 1..kByteBlock
  bool with_sign;
  std::int8_t exponent;
  float* out;
};
void unpack_byte_block(const ByteUnpacking& block) noexcept;

}  // namespace holdfast
