#include "client/measure/picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <stdexcept>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

namespace holdfast::measure {
namespace {

std::uint8_t to_byte(float value) {
  return static_cast<std::uint8_t>(std::clamp(value, 0.0f, 1.0f) * 255.0f + 0.5f);
}

/// IEC 61966-2-1.
float srgb_from_linear(float value) {
  return value <= 0.0031308f ? 12.92f * value : 1.055f * std::pow(value, 1 / 2.4f) - 0.055f;
}

/// Colours of equal steps of error; ours, of monotonic lightness.
constexpr std::array<std::array<float, 3>, 5> kErrorColors{{{0.00f, 0.00f, 0.02f},
                                                            {0.34f, 0.06f, 0.43f},
                                                            {0.73f, 0.21f, 0.33f},
                                                            {0.98f, 0.55f, 0.04f},
                                                            {0.99f, 1.00f, 0.64f}}};

std::array<float, 3> error_color(float error) {
  const float position = std::clamp(error / kErrorMapTop, 0.0f, 1.0f) * (kErrorColors.size() - 1);
  const std::size_t below = std::min(static_cast<std::size_t>(position), kErrorColors.size() - 2);
  const float share = position - static_cast<float>(below);
  std::array<float, 3> color{};
  for (std::size_t c = 0; c < 3; ++c)
    color[c] = (1 - share) * kErrorColors[below][c] + share * kErrorColors[below + 1][c];
  return color;
}

}  // namespace

Picture picture_of(const Plane& plane) {
  const Image judged = judged_image(clean_image(plane).image, measure_of(plane.id().kind));
  Picture out{judged.width, judged.height, std::vector<std::uint8_t>(judged.pixels() * 3)};
  for (std::size_t i = 0; i < judged.pixels(); ++i)
    for (int c = 0; c < 3; ++c)
      out.rgb[i * 3 + static_cast<std::size_t>(c)] =
          to_byte(srgb_from_linear(judged.channel(judged.channels == 1 ? 0 : c)[i]));
  return out;
}

Picture error_map(const Plane& result, const Plane& reference, const Mask& surface) {
  const Measure measure = measure_of(reference.id().kind);
  const Image a = judged_image(clean_image(result).image, measure);
  const Image b = judged_image(clean_image(reference).image, measure);
  Picture out{a.width, a.height, std::vector<std::uint8_t>(a.pixels() * 3, 128)};
  for (std::size_t i = 0; i < a.pixels(); ++i) {
    if (!surface[i]) continue;
    float error = 0;
    for (int c = 0; c < a.channels; ++c)
      error = std::max(error, std::abs(a.channel(c)[i] - b.channel(c)[i]));
    const auto color = error_color(error);
    for (std::size_t c = 0; c < 3; ++c) out.rgb[i * 3 + c] = to_byte(color[c]);
  }
  return out;
}

std::vector<unsigned char> png_bytes(const Picture& picture) {
  std::vector<unsigned char> bytes;
  OIIO::Filesystem::IOVecOutput memory(bytes);
  const auto output = OIIO::ImageOutput::create("png");
  OIIO::ImageSpec spec(picture.width, picture.height, 3, OIIO::TypeDesc::UINT8);
  spec.attribute("png:compressionLevel", 9);
  if (!output || !output->set_ioproxy(&memory) || !output->open("memory.png", spec) ||
      !output->write_image(OIIO::TypeDesc::UINT8, picture.rgb.data()) || !output->close())
    throw std::runtime_error("cannot encode a PNG: " +
                             (output ? output->geterror() : OIIO::geterror()));
  return bytes;
}

void write_png(const std::filesystem::path& file, const Picture& picture) {
  const auto bytes = png_bytes(picture);
  std::ofstream stream(file, std::ios::binary);
  stream.write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
  if (!stream.flush()) throw std::runtime_error("cannot write " + file.string());
}

std::string png_data_uri(const Picture& picture) {
  return "data:image/png;base64," + base64(png_bytes(picture));
}

std::string base64(const std::vector<unsigned char>& bytes) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 3; ++k) word = word << 8 | (k < count ? bytes[i + k] : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      out += k <= count ? kDigits[word >> (18 - 6 * k) & 63] : '=';
  }
  return out;
}

}  // namespace holdfast::measure
