#include <bit>
#include <cstring>
#include <map>
#include <memory>
#include <string>

#include <Imath/half.h>
#include <OpenImageIO/imageio.h>

#include "client/sequence/exr.h"
#include "client/sequence/exr_header.h"
#include "core/frame/error.h"

namespace holdfast {
namespace {

/// One channel of a file: where it goes, and where it lies in an interleaved native pixel.
struct FileChannel {
  ChannelRef target;
  OIIO::TypeDesc::BASETYPE type;
  std::size_t offset_bytes;
};

std::string file_subject(const std::filesystem::path& file) { return "file " + file.string(); }

std::string size_text(int width, int height) {
  return std::to_string(width) + "x" + std::to_string(height);
}

std::string type_text(OIIO::TypeDesc type) {
  return type == OIIO::TypeDesc::UINT ? "uint" : std::string(type.c_str());
}

std::unique_ptr<OIIO::ImageInput> open(const std::filesystem::path& file,
                                       std::optional<ImageSize> size) {
  const std::string subject = file_subject(file);
  if (!std::filesystem::is_regular_file(file))
    throw InputError(subject, "must be an existing EXR file", "missing");
  check_exr_header(file);
  auto input = OIIO::ImageInput::open(file.string());
  if (!input) throw InputError(subject, "must be a readable EXR file", OIIO::geterror());
  if (std::strcmp(input->format_name(), "openexr") != 0)
    throw InputError(subject, "must be an EXR file", input->format_name());
  const OIIO::ImageSpec& spec = input->spec();
  if (spec.deep) throw InputError(subject, "must hold a flat image", "deep");
  if (spec.width > kMaxDimension || spec.height > kMaxDimension)
    throw InputError(subject, "must have width and height in 1.." + std::to_string(kMaxDimension),
                     size_text(spec.width, spec.height));
  if (size && (spec.width != size->width || spec.height != size->height))
    throw InputError(subject, "must be " + size_text(size->width, size->height),
                     size_text(spec.width, spec.height));
  if (input->seek_subimage(1, 0)) throw InputError(subject, "must have one part", "multi-part");
  input->seek_subimage(0, 0);
  return input;
}

FileChannel file_channel(const std::string& subject, const OIIO::ImageSpec& spec, int index) {
  const std::string& name = spec.channelnames[static_cast<std::size_t>(index)];
  const std::string channel_subject = subject + ", channel " + name;
  const auto target = channel_from_name(name);
  if (!target) throw InputError(channel_subject, "must be one of the format", "unknown");
  const OIIO::TypeDesc type = spec.channelformat(index);
  const bool is_id = plane_traits(target->plane.kind).scalar == ScalarType::kUint;
  if (is_id && type != OIIO::TypeDesc::UINT)
    throw InputError(channel_subject, "must be uint", type_text(type));
  if (!is_id && type != OIIO::TypeDesc::HALF && type != OIIO::TypeDesc::FLOAT)
    throw InputError(channel_subject, "must be half or float", type_text(type));
  return {*target, static_cast<OIIO::TypeDesc::BASETYPE>(type.basetype),
          spec.pixel_bytes(0, index, true)};
}

/// All channels of the file, checked; planes are complete.
std::vector<FileChannel> file_channels(const std::filesystem::path& file,
                                       const OIIO::ImageSpec& spec) {
  const std::string subject = file_subject(file);
  std::vector<FileChannel> channels;
  std::map<PlaneId, int> found;
  for (int c = 0; c < spec.nchannels; ++c) {
    channels.push_back(file_channel(subject, spec, c));
    found[channels.back().target.plane] |= 1 << channels.back().target.channel;
  }
  for (const auto& [plane, mask] : found)
    for (int c = 0; c < channel_count(plane.kind); ++c)
      if ((mask & 1 << c) == 0)
        throw InputError(subject + ", channel " + channel_name(plane, c),
                         "must be present, as plane " + plane_name(plane) + " needs it", "missing");
  return channels;
}

template <class Convert>
void scatter(const std::byte* pixels, std::size_t pixel_bytes, ChannelView<std::uint32_t> view,
             Convert convert) {
  for (int y = 0; y < view.height; ++y)
    for (int x = 0; x < view.width; ++x, pixels += pixel_bytes) view.at(x, y) = convert(pixels);
}

/// Copies one channel out of interleaved native pixels; `view` holds the bits of floats or ids.
void scatter_channel(const FileChannel& channel, const std::byte* pixels, std::size_t pixel_bytes,
                     ChannelView<std::uint32_t> view) {
  if (channel.type == OIIO::TypeDesc::HALF) {
    scatter(pixels + channel.offset_bytes, pixel_bytes, view, [](const std::byte* p) {
      Imath::half value;
      std::memcpy(&value, p, sizeof value);
      return std::bit_cast<std::uint32_t>(static_cast<float>(value));
    });
  } else {
    scatter(pixels + channel.offset_bytes, pixel_bytes, view, [](const std::byte* p) {
      std::uint32_t value;
      std::memcpy(&value, p, sizeof value);
      return value;
    });
  }
}

}  // namespace

PlaneSet read_exr(const std::filesystem::path& file, std::optional<ImageSize> size) {
  const auto input = open(file, size);
  const OIIO::ImageSpec& spec = input->spec();
  const auto channels = file_channels(file, spec);

  // TypeDesc::UNKNOWN asks for native data: no channel is converted on the way.
  std::vector<std::byte> pixels(static_cast<std::size_t>(spec.image_bytes(true)));
  if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::UNKNOWN, pixels.data()))
    throw InputError(file_subject(file), "must be a readable EXR file", input->geterror());

  PlaneSet planes;
  const std::size_t pixel_bytes = spec.pixel_bytes(true);
  for (const FileChannel& channel : channels) {
    Plane& plane = planes.add(channel.target.plane, spec.width, spec.height);
    scatter_channel(channel, pixels.data(), pixel_bytes, plane.words(channel.target.channel));
  }
  return planes;
}

std::vector<PlaneId> exr_planes(const std::filesystem::path& file, std::optional<ImageSize> size) {
  const auto input = open(file, size);
  std::vector<PlaneId> planes;
  for (const FileChannel& channel : file_channels(file, input->spec()))
    if (channel.target.channel == 0) planes.push_back(channel.target.plane);
  return planes;
}

}  // namespace holdfast
