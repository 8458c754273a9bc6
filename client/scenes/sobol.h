#pragma once

#include <cstdint>

#include <glm/glm.hpp>

namespace holdfast::scenes {

/// Points of Sobol's sequence in the unit square, with Owen's scrambling by hashing (Burley,
/// "Practical Hash-based Owen Scrambling", JCGT 2020). Each scrambling is a random sequence of its
/// own whose points are uniform; the first 2^m points, and each 2^m after them, lie one each in
/// every grid of 2^m equal boxes.

/// The bits of `x` in reverse order.
constexpr std::uint32_t reverse_bits(std::uint32_t x) {
  x = (x >> 16) | (x << 16);
  x = ((x & 0xff00ff00u) >> 8) | ((x & 0x00ff00ffu) << 8);
  x = ((x & 0xf0f0f0f0u) >> 4) | ((x & 0x0f0f0f0fu) << 4);
  x = ((x & 0xccccccccu) >> 2) | ((x & 0x33333333u) << 2);
  return ((x & 0xaaaaaaaau) >> 1) | ((x & 0x55555555u) << 1);
}

/// Permutes numbers so that each bit depends on `seed` and lower bits alone (Laine and Karras, with
/// Vegdahl's constants): Owen's scrambling of a fraction whose bits are reversed.
constexpr std::uint32_t scramble_reversed(std::uint32_t x, std::uint32_t seed) {
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16) | 1u;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return x;
}

/// The second coordinate of Sobol's point `i`, bits reversed: Pascal's triangle modulo 2 times i.
constexpr std::uint32_t sobol_second_reversed(std::uint32_t i) {
  i ^= (i >> 16);
  i ^= (i & 0xff00ff00u) >> 8;
  i ^= (i & 0xf0f0f0f0u) >> 4;
  i ^= (i & 0xccccccccu) >> 2;
  i ^= (i & 0xaaaaaaaau) >> 1;
  return i;
}

/// Point `i` of the sequence with this scrambling, in [0,1)^2.
inline glm::dvec2 sobol_point(std::uint32_t i, std::uint64_t scrambling) {
  const auto low = static_cast<std::uint32_t>(scrambling);
  const auto high = static_cast<std::uint32_t>(scrambling >> 32);
  return {reverse_bits(scramble_reversed(i, low)) * 0x1.0p-32,
          reverse_bits(scramble_reversed(sobol_second_reversed(i), high)) * 0x1.0p-32};
}

}  // namespace holdfast::scenes
