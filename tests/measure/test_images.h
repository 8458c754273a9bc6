#pragma once

#include <cstdint>
#include <initializer_list>

#include "client/measure/image.h"

namespace holdfast::measure::test {

inline Image constant(int width, int height, std::initializer_list<float> color) {
  Image image(width, height, static_cast<int>(color.size()));
  int c = 0;
  for (const float value : color) {
    for (std::size_t i = 0; i < image.pixels(); ++i) image.channel(c)[i] = value;
    ++c;
  }
  return image;
}

inline Mask all(const Image& image) { return Mask(image.pixels(), 1); }

/// Uniform numbers in [0,1) that a script in another language makes as well: a 32-bit linear
/// congruential generator (Numerical Recipes), its top 24 bits.
class Noise {
 public:
  explicit Noise(std::uint32_t seed) : state_(seed) {}
  float next() {
    state_ = 1664525u * state_ + 1013904223u;
    return static_cast<float>(state_ >> 8) / 16777216.0f;
  }
  Image image(int width, int height, int channels) {
    Image out(width, height, channels);
    for (float& value : out.values) value = next();
    return out;
  }

 private:
  std::uint32_t state_;
};

}  // namespace holdfast::measure::test
