#pragma once

#include <cstddef>
#include <vector>

/// The oracle: the whole method once more, in double, one pixel after the other, in plain loops. No
/// blocks, lanes, tiles, threads or instruction sets; nothing is skipped and nothing is tabulated.
/// Kernels are measured against it; nobody should have to wait for it otherwise. It shares with
/// them the frame's types, a recipe's constants, and formulas that are templates of the number's
/// type; all else is written anew from what the headers of the stages say.
namespace holdfast::oracle {

/// An image of doubles with `channels` values a pixel.
class Image {
 public:
  Image() = default;
  Image(int width, int height, int channels, double value = 0.0)
      : width_(width), height_(height), channels_(channels) {
    values_.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) *
                       static_cast<std::size_t>(channels),
                   value);
  }

  int width() const { return width_; }
  int height() const { return height_; }
  int channels() const { return channels_; }
  explicit operator bool() const { return channels_ > 0; }
  std::size_t bytes() const { return values_.size() * sizeof(double); }

  double& at(int x, int y, int c = 0) { return values_[index(x, y, c)]; }
  double at(int x, int y, int c = 0) const { return values_[index(x, y, c)]; }

 private:
  std::size_t index(int x, int y, int c) const {
    return (static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
            static_cast<std::size_t>(x)) *
               static_cast<std::size_t>(channels_) +
           static_cast<std::size_t>(c);
  }

  int width_ = 0, height_ = 0, channels_ = 0;
  std::vector<double> values_;
};

/// Calls body(x, y) for every pixel, row by row.
template <class Body>
void for_each_pixel(int width, int height, const Body& body) {
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) body(x, y);
}

/// Rec. 709 luminance of a pixel; the value itself of one channel.
inline double luminance_at(const Image& image, int x, int y) {
  if (image.channels() == 1) return image.at(x, y);
  return 0.2126 * image.at(x, y, 0) + 0.7152 * image.at(x, y, 1) + 0.0722 * image.at(x, y, 2);
}

inline double square(double v) { return v * v; }

}  // namespace holdfast::oracle
