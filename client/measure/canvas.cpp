#include "client/measure/canvas.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace holdfast::measure {

Picture blank(int width, int height) {
  return {width, height,
          std::vector<std::uint8_t>(static_cast<std::size_t>(width) *
                                    static_cast<std::size_t>(height) * 3)};
}

void set_pixel(Picture& picture, int x, int y, Rgb color) {
  if (x < 0 || y < 0 || x >= picture.width || y >= picture.height) return;
  const std::size_t at = (static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width) +
                          static_cast<std::size_t>(x)) *
                         3;
  std::copy(color.begin(), color.end(), picture.rgb.begin() + static_cast<std::ptrdiff_t>(at));
}

void paste(Picture& picture, const Picture& from, int x, int y, int zoom) {
  for (int v = 0; v < from.height * zoom; ++v)
    for (int u = 0; u < from.width * zoom; ++u) {
      const std::size_t at =
          (static_cast<std::size_t>(v / zoom) * static_cast<std::size_t>(from.width) +
           static_cast<std::size_t>(u / zoom)) *
          3;
      set_pixel(picture, x + u, y + v, {from.rgb[at], from.rgb[at + 1], from.rgb[at + 2]});
    }
}

void draw_line(Picture& picture, double x0, double y0, double x1, double y1, Rgb color) {
  const double length = std::max(std::abs(x1 - x0), std::abs(y1 - y0));
  const int steps = std::max(1, static_cast<int>(std::ceil(std::min(length, 1e5))));
  for (int i = 0; i <= steps; ++i) {
    const double t = static_cast<double>(i) / steps;
    set_pixel(picture, static_cast<int>(std::floor(x0 + t * (x1 - x0))),
              static_cast<int>(std::floor(y0 + t * (y1 - y0))), color);
  }
}

void draw_arrow(Picture& picture, double x0, double y0, double x1, double y1, Rgb color) {
  draw_line(picture, x0, y0, x1, y1, color);
  const double dx = x1 - x0, dy = y1 - y0, length = std::hypot(dx, dy);
  if (length < 1) return;
  const double head = std::min(5.0, 0.45 * length) / length;
  for (const double side : {-0.6, 0.6})
    draw_line(picture, x1, y1, x1 - head * (dx - side * dy), y1 - head * (dy + side * dx), color);
}

double round_scale(double value) {
  double scale = 0.01;
  for (int i = 0; scale < value * (1 - 1e-9) && i < 60; ++i) scale *= i % 3 == 1 ? 2.5 : 2;
  return scale;
}

std::string scale_text(double scale) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.10g", std::round(scale * 100) / 100);
  return text.data();
}

}  // namespace holdfast::measure
