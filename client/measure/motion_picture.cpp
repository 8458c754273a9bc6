#include "client/measure/motion_picture.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace holdfast::measure {
namespace {

constexpr Rgb kGrey{128, 128, 128}, kBlack{0, 0, 0};

std::size_t index(const Image& image, int x, int y) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
         static_cast<std::size_t>(x);
}

/// HSV with value 1; hue and saturation in 0..1.
Rgb from_hue(double hue, double saturation) {
  Rgb rgb{};
  for (int c = 0; c < 3; ++c) {
    const double k = std::fmod(hue * 6 + (c == 0 ? 0 : c == 1 ? 4 : 2), 6.0);
    const double pure = std::clamp(std::abs(k - 3) - 1, 0.0, 1.0);
    const double value = 1 - saturation + saturation * pure;
    rgb[static_cast<std::size_t>(c)] = static_cast<std::uint8_t>(std::lround(value * 255));
  }
  return rgb;
}

}  // namespace

Rgb motion_color(double x_px, double y_px, double scale_px) {
  const double length = std::hypot(x_px, y_px);
  if (!std::isfinite(length)) return kBlack;
  const double turn = std::atan2(y_px, x_px) / (2 * std::numbers::pi);
  return from_hue(turn < 0 ? turn + 1 : turn, std::min(length / scale_px, 1.0));
}

Picture motion_picture(const Image& motion_px, const Mask& shown, double scale_px) {
  Picture out = blank(motion_px.width, motion_px.height);
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x) {
      const std::size_t i = index(motion_px, x, y);
      set_pixel(out, x, y,
                shown[i] ? motion_color(static_cast<double>(motion_px.channel(0)[i]),
                                        static_cast<double>(motion_px.channel(1)[i]), scale_px)
                         : kGrey);
    }
  return out;
}

void draw_motion_arrows(Picture& picture, const Image& motion_px, const Mask& shown,
                        double scale_px, int zoom) {
  constexpr int kSpacing = 24;
  for (int v = kSpacing / 2; v < motion_px.height * zoom; v += kSpacing)
    for (int u = kSpacing / 2; u < motion_px.width * zoom; u += kSpacing) {
      const std::size_t i = index(motion_px, u / zoom, v / zoom);
      const auto x = static_cast<double>(motion_px.channel(0)[i]);
      const auto y = static_cast<double>(motion_px.channel(1)[i]);
      const double length = std::hypot(x, y);
      if (!shown[i] || !std::isfinite(length)) continue;
      const double grow = kSpacing / std::max(scale_px, length);  // none is longer
      draw_arrow(picture, u, v, u + x * grow, v + y * grow, kBlack);
    }
}

Picture motion_wheel(int radius) {
  Picture out = blank(2 * radius + 1, 2 * radius + 1);
  for (int y = -radius; y <= radius; ++y)
    for (int x = -radius; x <= radius; ++x)
      if (x * x + y * y <= radius * radius)
        set_pixel(out, radius + x, radius + y, motion_color(x, y, radius));
  return out;
}

double motion_scale(const Image& motion_px, const Mask& shown) {
  std::vector<float> lengths;
  for (std::size_t i = 0; i < motion_px.pixels(); ++i) {
    const float length = std::hypot(motion_px.channel(0)[i], motion_px.channel(1)[i]);
    if (shown[i] && std::isfinite(length) && length > 0.01f) lengths.push_back(length);
  }
  if (lengths.empty()) return round_scale(0);
  const auto place = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() * 19 / 20);
  std::nth_element(lengths.begin(), place, lengths.end());
  return round_scale(static_cast<double>(*place));
}

}  // namespace holdfast::measure
