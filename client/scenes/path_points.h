#pragma once

#include <cstdint>

#include <glm/glm.hpp>

#include "client/scenes/rng.h"
#include "client/scenes/sobol.h"

namespace holdfast::scenes {

/// The points of one of many paths that one average is taken of. Pair k of all paths together is a
/// scrambled sequence of Sobol's, in an order of its own, so that each pair is spread evenly and no
/// two pairs go together. Takes the place of `Rng`.
class PathPoints {
 public:
  /// Path `index` of those with this `seed`.
  PathPoints(std::uint64_t seed, std::uint32_t index) : state_(seed), index_(index) {}

  glm::dvec2 next2() {
    state_ += kStep;
    const std::uint64_t order = mix_bits(state_);
    state_ += kStep;
    const std::uint32_t i = reverse_bits(
        scramble_reversed(reverse_bits(index_), static_cast<std::uint32_t>(order >> 32)));
    return sobol_point(i, mix_bits(state_));
  }

 private:
  static constexpr std::uint64_t kStep = 0x9e3779b97f4a7c15ull;  // as in Rng
  std::uint64_t state_;
  std::uint32_t index_;
};

}  // namespace holdfast::scenes
