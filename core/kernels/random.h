#pragma once

#include <cstdint>

#include "core/kernels/math.h"

namespace holdfast {

/// Reproducible random numbers: a function of a key alone, such as (pixel, frame, session seed).
/// Finaliser of SplitMix64 (Steele et al., OOPSLA 2014).
HOLDFAST_INLINE constexpr std::uint64_t mix_bits(std::uint64_t x) noexcept {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
  return x ^ (x >> 31);
}

/// Two numbers in (0, 1) from one key.
struct UniformPair {
  float u, v;
};
HOLDFAST_INLINE constexpr UniformPair uniform_pair(std::uint64_t key) noexcept {
  const std::uint64_t bits = mix_bits(key + 0x9e3779b97f4a7c15ull);
  // By way of 32 bits, which vectors convert everywhere.
  const auto first = static_cast<std::int32_t>(bits & 0x7fffffu);
  const auto second = static_cast<std::int32_t>((bits >> 32) & 0x7fffffu);
  return {(static_cast<float>(first) + 0.5f) * 0x1.0p-23f,
          (static_cast<float>(second) + 0.5f) * 0x1.0p-23f};
}

}  // namespace holdfast
