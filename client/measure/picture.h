#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "client/measure/judged.h"

namespace holdfast::measure {

/// An 8-bit RGB picture for people, sRGB.
struct Picture {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;
};

/// A layer as people see it: judged values, encoded as sRGB; one channel becomes grey.
Picture picture_of(const Plane& plane);

/// Errors from this up are shown in the error map's brightest colour.
inline constexpr float kErrorMapTop = 0.25f;

/// Largest difference of judged values over the channels, black at 0 over violet and orange to
/// light yellow at kErrorMapTop; sky is mid-grey.
Picture error_map(const Plane& result, const Plane& reference, const Mask& surface);

/// The picture as a PNG file in memory.
std::vector<unsigned char> png_bytes(const Picture& picture);

/// Writes a PNG file; throws std::runtime_error if that fails.
void write_png(const std::filesystem::path& file, const Picture& picture);

/// "data:image/png;base64,...", for use within a page.
std::string png_data_uri(const Picture& picture);

/// Base64 (RFC 4648 section 4) with padding.
std::string base64(const std::vector<unsigned char>& bytes);

}  // namespace holdfast::measure
