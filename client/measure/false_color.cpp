#include "client/measure/false_color.h"

#include <algorithm>
#include <cmath>

namespace holdfast::measure {
namespace {

/// Equal steps of the map; ours, of monotonic lightness.
constexpr std::array<std::array<double, 3>, 5> kStops{{{0.12, 0.05, 0.33},
                                                       {0.18, 0.30, 0.55},
                                                       {0.10, 0.56, 0.53},
                                                       {0.48, 0.80, 0.32},
                                                       {0.99, 0.91, 0.14}}};

}  // namespace

Rgb false_color(double share) {
  const double position = std::clamp(share, 0.0, 1.0) * (kStops.size() - 1);
  const std::size_t below = std::min(static_cast<std::size_t>(position), kStops.size() - 2);
  const double part = position - static_cast<double>(below);
  Rgb color{};
  for (std::size_t c = 0; c < 3; ++c)
    color[c] = static_cast<std::uint8_t>(
        std::lround(255 * ((1 - part) * kStops[below][c] + part * kStops[below + 1][c])));
  return color;
}

Picture false_color_picture(const Image& values, const Mask& shown, double top) {
  constexpr Rgb kGrey{128, 128, 128}, kBlack{0, 0, 0};
  Picture out = blank(values.width, values.height);
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x) {
      const std::size_t i = static_cast<std::size_t>(y) * static_cast<std::size_t>(out.width) +
                            static_cast<std::size_t>(x);
      const auto value = static_cast<double>(values.channel(0)[i]);
      set_pixel(out, x, y,
                !shown[i]               ? kGrey
                : !std::isfinite(value) ? kBlack
                                        : false_color(value / top));
    }
  return out;
}

Picture false_color_bar(int width, int height) {
  Picture out = blank(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) set_pixel(out, x, y, false_color((x + 0.5) / width));
  return out;
}

}  // namespace holdfast::measure
