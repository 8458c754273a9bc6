#include "client/sequence/exr_header.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "client/sequence/strict_json.h"
#include "core/frame/error.h"
#include "core/frame/plane.h"

namespace holdfast {
namespace {

constexpr std::uint32_t kMagic = 20000630, kMultiPart = 0x1000;
constexpr std::size_t kLongestName = 255;
constexpr std::size_t kSmallTile = 256 * 256;  // pixels: beyond the image, common in small images
// Deflate makes 1032 bytes one at best, PXR24 a quarter less; DWA drops 63 of 64 numbers before.
constexpr std::size_t kExpansion = 2048, kDwaExpansion = 64 * kExpansion;
constexpr int kDwaa = 8, kDwab = 9;

struct FixedSize {
  std::string_view type;
  std::size_t bytes;
};
constexpr FixedSize kFixedSizes[] = {
    {"box2f", 16},         {"box2i", 16},    {"chromaticities", 32},
    {"compression", 1},    {"double", 8},    {"envmap", 1},
    {"deepImageState", 1}, {"float", 4},     {"int", 4},
    {"keycode", 28},       {"lineOrder", 1}, {"m33d", 72},
    {"m33f", 36},          {"m44d", 128},    {"m44f", 64},
    {"rational", 8},       {"tiledesc", 9},  {"timecode", 8},
    {"v2d", 16},           {"v2f", 8},       {"v2i", 8},
    {"v3d", 24},           {"v3f", 12},      {"v3i", 12}};

/// The file from its begin, as far as headers go.
class HeaderReader {
 public:
  explicit HeaderReader(const std::filesystem::path& file)
      : subject_("file " + file.string()), stream_(file, std::ios::binary | std::ios::ate) {
    size_ = stream_ ? static_cast<std::size_t>(std::max<std::streamoff>(stream_.tellg(), 0)) : 0;
    stream_.seekg(0);
  }

  ExrHeader read() {
    if (number(bytes(4)) != kMagic) fail("with another beginning");
    const bool parts = (number(bytes(4)) & kMultiPart) != 0;
    ExrHeader largest;
    do {
      const ExrHeader part = read_part();
      if (part.image_bytes() >= largest.image_bytes()) largest = part;
    } while (parts && stream_.peek() != 0);
    return largest;
  }

 private:
  struct Tile {
    std::uint64_t width = 0, height = 0;  ///< below 2^32
  };

  [[noreturn]] void fail(const std::string& value) const {
    throw InputError(subject_, "must be a readable EXR file", value);
  }

  std::string bytes(std::size_t count) {
    if (count > left()) fail("cut off");
    std::string out(count, '\0');
    if (!stream_.read(out.data(), static_cast<std::streamsize>(count))) fail("cut off");
    at_ += count;
    return out;
  }
  std::size_t left() const { return size_ - at_; }

  static std::uint32_t number(std::string_view from, std::size_t at = 0) {
    std::uint32_t value = 0;  // little endian, as this machine is
    std::memcpy(&value, from.data() + at, sizeof value);
    return value;
  }

  std::string text() {
    std::string out;
    for (char c = bytes(1)[0]; c != '\0'; c = bytes(1)[0]) {
      out += c;
      if (out.size() > kLongestName) fail("with a name of more than 255 bytes in its header");
    }
    return out;
  }

  ExrHeader read_part() {
    header_ = {};
    tile_ = {};
    compression_ = 0;
    for (std::string name = text(); !name.empty(); name = text()) {
      const std::string type = text();
      const std::uint32_t size = number(bytes(4));
      if (size > left())
        fail("with attribute " + shortened(name) + " of " + std::to_string(size) +
             " bytes, beyond " + "its end");
      read_attribute(name, type, bytes(size));
    }
    check_part();
    return header_;
  }

  /// A value must be as long as it says, or what follows is not where the library looks for it.
  void read_attribute(const std::string& name, const std::string& type, const std::string& value) {
    const auto need = [&](bool right) {
      if (!right) fail("with attribute " + shortened(name) + " of the wrong size");
    };
    for (const FixedSize& known : kFixedSizes)
      need(type != known.type || value.size() == known.bytes);
    if (type == "preview") {
      need(value.size() >= 8);
      need(8 + 4 * std::uint64_t{number(value)} * number(value, 4) == value.size());
    } else if (type == "stringvector") {
      for (std::size_t at = 0; at < value.size();) {
        need(value.size() - at >= 4);
        const std::size_t length = number(value, at);
        need(length <= value.size() - at - 4);
        at += 4 + length;
      }
    } else if (type == "floatvector") {
      need(value.size() % 4 == 0);
    } else if (type == "idmanifest") {
      need(value.size() >= 4);
    } else if (type == "chlist") {
      const std::size_t bytes = channel_bytes(value);
      need(bytes > 0);
      if (name == "channels") header_.pixel_bytes = bytes;
    } else if (name == "dataWindow") {
      need(value.size() == 16);
      header_.width = extent(number(value, 0), number(value, 8));
      header_.height = extent(number(value, 4), number(value, 12));
    } else if (name == "tiles") {
      need(value.size() == 9);
      tile_ = {number(value, 0), number(value, 4)};
    } else if (name == "compression") {
      need(value.size() == 1);
      compression_ = static_cast<unsigned char>(value[0]);
    }
  }

  static std::size_t extent(std::uint32_t low, std::uint32_t high) {
    const auto pixels =
        std::int64_t{static_cast<std::int32_t>(high)} - static_cast<std::int32_t>(low) + 1;
    return pixels > 0 ? static_cast<std::size_t>(pixels) : 0;
  }

  /// Of a pixel; 0 if the list does not end where its value does, or holds nothing.
  static std::size_t channel_bytes(const std::string& list) {
    constexpr std::size_t kRest = 16;  // type, flags, sampling
    std::size_t sum = 0, at = 0;
    while (at < list.size() && list[at] != '\0') {
      const std::size_t end = list.find('\0', at);
      if (end == list.npos || list.size() - end - 1 < kRest) return 0;
      sum += number(list, end + 1) == 1 ? 2 : 4;  // half, else uint or float
      at = end + 1 + kRest;
    }
    return at + 1 == list.size() ? sum : 0;
  }

  void check_part() const {
    const auto [width, height, pixel_bytes] = header_;
    if (width < 1 || height < 1 || width > std::size_t{kMaxDimension} ||
        height > std::size_t{kMaxDimension})
      throw InputError(subject_,
                       "must have width and height in 1.." + std::to_string(kMaxDimension),
                       std::to_string(width) + "x" + std::to_string(height));
    if (tile_.width * tile_.height >
        std::max(std::uint64_t{width * height}, std::uint64_t{kSmallTile}))
      fail("with tiles of " + std::to_string(tile_.width) + "x" + std::to_string(tile_.height));
    const bool dwa = compression_ == kDwaa || compression_ == kDwab;
    const std::size_t least = header_.image_bytes() / (dwa ? kDwaExpansion : kExpansion);
    if (size_ < least)
      throw InputError(subject_,
                       "must have at least " + std::to_string(least) + " bytes for " +
                           std::to_string(width) + "x" + std::to_string(height) + " pixels of " +
                           std::to_string(pixel_bytes) + " bytes",
                       std::to_string(size_) + " bytes");
  }

  const std::string subject_;
  std::ifstream stream_;
  std::size_t size_ = 0, at_ = 0;
  ExrHeader header_;
  Tile tile_;
  int compression_ = 0;
};

}  // namespace

ExrHeader check_exr_header(const std::filesystem::path& file) { return HeaderReader(file).read(); }

}  // namespace holdfast
