#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "client/measure/picture.h"

namespace holdfast::measure {

using Rgb = std::array<std::uint8_t, 3>;

/// A black picture.
Picture blank(int width, int height);

/// Sets one pixel; outside the picture nothing happens.
void set_pixel(Picture& picture, int x, int y, Rgb color);

/// Copies `from` with its top left corner at (x, y), each pixel `zoom` pixels large.
void paste(Picture& picture, const Picture& from, int x, int y, int zoom);

/// A line of one pixel's width from (x0, y0) to (x1, y1), both included.
void draw_line(Picture& picture, double x0, double y0, double x1, double y1, Rgb color);

/// A line with a head at (x1, y1); a dot if it is shorter than a pixel.
void draw_arrow(Picture& picture, double x0, double y0, double x1, double y1, Rgb color);

/// The smallest of 1, 2, 5, 10, ... times a power of ten that is at least `value`; 0.01 for less.
double round_scale(double value);

/// "0.05", "2", "50": a round scale as text.
std::string scale_text(double scale);

}  // namespace holdfast::measure
