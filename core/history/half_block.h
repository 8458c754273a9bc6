#pragma once

#include <cstdint>

/// Halves with a common exponent: how a run of a row's values is kept between frames in two bytes
/// each. A block's values are multiplied by the power of two that brings the greatest of them to
/// 2^14..2^15 and stored as IEEE halves: 11 bits from the greatest down to 2^-29 of it, and steps
/// of 2^-39 of it below. No scale of radiance is out of range, and a change of scale by a power of
/// two changes no bit of what is stored.
namespace holdfast {

inline constexpr int kHalfBlock = 64;  ///< values
inline constexpr int kHalfGroup = 16;  ///< values that are read and written together

/// Random bits for each value of a block, a function of the seed alone.
struct BlockBits {
  std::uint32_t seed;
  std::uint32_t* out;  ///< kHalfBlock
};
void draw_block_bits(const BlockBits& block) noexcept;

/// Rounds values up or down with the probability that keeps their mean: a mean of many samples
/// would otherwise stop where a new sample changes it by less than half a step, and what is dark
/// beside something very bright would go to 0. What halves hold exactly stays as it is. The
/// same values and random bits give the same bits on every instruction set.
struct HalfPacking {
  const float* in;              ///< finite, absolute values below 1e38
  int count;                    ///< 1..kHalfBlock
  const std::uint32_t* random;  ///< of draw_block_bits
  std::uint16_t* out;           ///< whole groups are written
  std::int8_t* exponent;        ///< written: of the power of two, -126..126
};
void pack_half_block(const HalfPacking& block) noexcept;

/// The values again.
struct HalfUnpacking {
  const std::uint16_t* in;  ///< whole groups are read
  int count;                ///< 1..kHalfBlock
  std::int8_t exponent;
  float* out;  ///< whole groups are written
};
void unpack_half_block(const HalfUnpacking& block) noexcept;

}  // namespace holdfast
