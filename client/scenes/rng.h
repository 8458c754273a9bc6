#pragma once

#include <cstdint>

#include <glm/glm.hpp>

namespace holdfast::scenes {

/// Mixes 64 bits so that every input bit moves every output bit (SplitMix64's finaliser).
constexpr std::uint64_t mix_bits(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
  return x ^ (x >> 31);
}

/// Random numbers that are a function of (seed, frame, pixel, stream) and of their place in the
/// stream, so that images do not depend on the order in which pixels are rendered.
class Rng {
 public:
  Rng(std::uint64_t seed, std::uint64_t frame, std::uint64_t pixel, std::uint64_t stream)
      : state_(
            mix_bits(seed + kStep * mix_bits(frame + kStep * mix_bits(pixel + kStep * stream)))) {}

  std::uint64_t bits() {
    state_ += kStep;
    return mix_bits(state_);
  }
  /// Uniform in [0, 1).
  double next() { return static_cast<double>(bits() >> 11) * 0x1.0p-53; }
  glm::dvec2 next2() {
    const double u = next();
    return {u, next()};
  }

 private:
  static constexpr std::uint64_t kStep = 0x9e3779b97f4a7c15ull;  // 2^64 / golden ratio, odd
  std::uint64_t state_;
};

}  // namespace holdfast::scenes
