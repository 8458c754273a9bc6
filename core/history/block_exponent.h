#pragma once

#include <bit>
#include <cstdint>

#include "core/kernels/math.h"

/// What blocks with a common exponent share: half_block.cpp and byte_block.cpp.
namespace holdfast {

inline constexpr std::uint32_t kMagnitudeBits = 0x7fffffffu;  // of a float: all but the sign
inline constexpr int kFloatBias = 127;
inline constexpr int kMostShift = 126;

HOLDFAST_INLINE float power_of_two(int exponent) {
  return std::bit_cast<float>(static_cast<std::uint32_t>(exponent + kFloatBias) << 23);
}

/// The exponent of the power of two that brings the greatest of the values to 2^greatest and above,
/// below twice that.
HOLDFAST_INLINE int block_shift(const float* in, int count, int greatest) {
  std::int32_t most = 0;
  for (int i = 0; i < count; ++i) {
    const auto bits =
        static_cast<std::int32_t>(std::bit_cast<std::uint32_t>(in[i]) & kMagnitudeBits);
    most = bits > most ? bits : most;
  }
  return min_of(greatest + kFloatBias - (most >> 23), kMostShift);
}

}  // namespace holdfast
