#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace holdfast::server {

/// An RGB picture of 8 bits a channel, rows from the top.
struct Rgb8 {
  int width = 0, height = 0;
  std::vector<std::uint8_t> values;  ///< width * height * 3
};

/// The picture as a PNG file (W3C PNG, third edition: colour type 2, no filter, one IDAT). Throws
/// std::runtime_error if it cannot be compressed.
std::string png(const Rgb8& picture);

}  // namespace holdfast::server
