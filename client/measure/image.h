#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace holdfast::measure {

/// Planar float image without padding: channel c starts at c * pixels().
struct Image {
  int width = 0;
  int height = 0;
  int channels = 0;
  std::vector<float> values;

  Image() = default;
  Image(int w, int h, int c)
      : width(w), height(h), channels(c), values(pixels() * static_cast<std::size_t>(c)) {}

  std::size_t pixels() const {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  }
  float* channel(int c) { return values.data() + pixels() * static_cast<std::size_t>(c); }
  const float* channel(int c) const {
    return values.data() + pixels() * static_cast<std::size_t>(c);
  }
  bool empty() const { return values.empty(); }
};

/// One byte a pixel, 1 = counts.
using Mask = std::vector<std::uint8_t>;

}  // namespace holdfast::measure
