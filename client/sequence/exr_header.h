#pragma once

#include <cstddef>
#include <filesystem>

namespace holdfast {

/// What the header of an EXR file says of its size.
struct ExrHeader {
  std::size_t width = 0, height = 0;  ///< pixels, 1..kMaxDimension
  std::size_t pixel_bytes = 0;        ///< of all channels, as they lie in the file
  std::size_t image_bytes() const { return width * height * pixel_bytes; }
};

/// Reads the header of an EXR file before the library does, which allocates what it says unseen.
/// Of several parts it is that of the largest. Throws InputError that names the file if it is no
/// EXR file or its header is cut off; if an attribute, a text or a preview in it is larger than the
/// file; if the image is larger than kMaxDimension, a tile larger than the image and 256x256, or
/// the file too small for its pixels: no lossless compression makes them 2048 times smaller, and
/// DWA not 131072 times.
ExrHeader check_exr_header(const std::filesystem::path& file);

}  // namespace holdfast
