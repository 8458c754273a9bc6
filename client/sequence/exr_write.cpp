#include <bit>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <string>

#include <Imath/half.h>
#include <OpenImageIO/imageio.h>

#include "client/sequence/exr.h"
#include "core/frame/error.h"

namespace holdfast {
namespace {

/// Size shared by all planes.
ImageSize common_size(const std::filesystem::path& file, std::span<const Plane* const> planes) {
  const std::string subject = "file " + file.string();
  if (planes.empty()) throw InputError(subject, "must get at least one plane", "given none");
  const ImageSize size{planes.front()->width(), planes.front()->height()};
  for (const Plane* plane : planes)
    if (plane->width() != size.width || plane->height() != size.height)
      throw InputError(subject + ", plane " + plane_name(plane->id()),
                       "must be " + std::to_string(size.width) + "x" + std::to_string(size.height) +
                           " like the file's other planes",
                       std::to_string(plane->width()) + "x" + std::to_string(plane->height()));
  return size;
}

/// Copies one channel to its place in interleaved native pixels.
void gather(ChannelView<const std::uint32_t> view, bool as_half, std::byte* pixels,
            std::size_t pixel_bytes) {
  for (int y = 0; y < view.height; ++y) {
    for (int x = 0; x < view.width; ++x, pixels += pixel_bytes) {
      const std::uint32_t word = view.at(x, y);
      if (as_half) {
        const Imath::half value(std::bit_cast<float>(word));
        std::memcpy(pixels, &value, sizeof value);
      } else {
        std::memcpy(pixels, &word, sizeof word);
      }
    }
  }
}

}  // namespace

void write_exr(const std::filesystem::path& file, const PlaneSet& planes, ExrOptions options) {
  std::vector<const Plane*> all;
  for (const Plane& plane : planes) all.push_back(&plane);
  write_exr_planes(file, all, options);
}

void write_exr_planes(const std::filesystem::path& file, std::span<const Plane* const> planes,
                      ExrOptions options) {
  const ImageSize size = common_size(file, planes);
  OIIO::ImageSpec spec(size.width, size.height, 0, OIIO::TypeDesc::FLOAT);
  spec.channelnames.clear();
  for (const Plane* plane : planes) {
    const auto real = options.half ? OIIO::TypeDesc::HALF : OIIO::TypeDesc::FLOAT;
    for (int c = 0; c < plane->channels(); ++c) {
      spec.channelnames.push_back(channel_name(plane->id(), c));
      spec.channelformats.emplace_back(plane->is_uint() ? OIIO::TypeDesc::UINT : real);
      ++spec.nchannels;
    }
  }
  spec.attribute("compression", "zip:1");  // noise hardly shrinks: the fastest level

  std::vector<std::byte> pixels(static_cast<std::size_t>(spec.image_bytes(true)));
  const std::size_t pixel_bytes = spec.pixel_bytes(true);
  int index = 0;
  for (const Plane* plane : planes)
    for (int c = 0; c < plane->channels(); ++c, ++index)
      gather(plane->words(c), options.half && !plane->is_uint(),
             pixels.data() + spec.pixel_bytes(0, index, true), pixel_bytes);

  const auto output = OIIO::ImageOutput::create("openexr");
  if (!output) throw std::runtime_error("OpenImageIO has no EXR writer: " + OIIO::geterror());
  if (!output->open(file.string(), spec) ||
      !output->write_image(OIIO::TypeDesc::UNKNOWN, pixels.data()) || !output->close())
    throw std::runtime_error("cannot write " + file.string() + ": " + output->geterror());
}

}  // namespace holdfast
