#include "tests/stability/fuzz_exr_case.h"

#include <algorithm>
#include <exception>
#include <fstream>
#include <iterator>
#include <optional>
#include <vector>

#include <OpenImageIO/imageio.h>

#include "client/sequence/exr.h"
#include "client/sequence/exr_header.h"
#include "core/frame/error.h"
#include "tests/stability/peak_memory.h"

namespace holdfast::test {
namespace {

constexpr std::size_t kMemoryBase = 24u << 20, kMemoryLimit = 512u << 20;
constexpr std::size_t kLongestMessage = 1500;  // beside the file's name

/// What parts of headers are made of.
constexpr std::string_view kWords[] = {
    "channels",
    "chlist",
    "compression",
    "dataWindow",
    "box2i",
    "displayWindow",
    "lineOrder",
    "tiles",
    "tiledesc",
    "preview",
    "type",
    "string",
    "idmanifest",
    "stringvector",
    "floatvector",
    "chunkCount",
    "scanlineimage",
    "deepscanline",
    "tiledimage",
    "deeptile",
    "version",
    "name",
    "R",
    "depth.Z",
    "normal.X",
    "objectId",
    "light99999999999.visibility",
    std::string_view("\0", 1),
    std::string_view("\0\0\0\0", 4),
    std::string_view("\xff\xff\xff\x7f", 4),
    std::string_view("\xff\x3f\0\0", 4),
    std::string_view("stringvector\0\x10\0\0\0\xff\xff\xff\x7f", 21)};

struct Sample {
  int width, height;
  std::string bytes;
};

/// A file as another program may have written it.
Sample written(Random& random, const std::filesystem::path& file) {
  constexpr const char* kCompressions[] = {"none",  "rle", "zips", "zip",  "piz",
                                           "pxr24", "b44", "b44a", "dwaa", "dwab"};
  const int width = 1 + static_cast<int>(below(random, 40));
  const int height = 1 + static_cast<int>(below(random, 40));
  OIIO::ImageSpec spec(width, height, 0, OIIO::TypeDesc::FLOAT);
  const auto add = [&](const char* name, OIIO::TypeDesc::BASETYPE type) {
    spec.channelnames.emplace_back(name);
    spec.channelformats.emplace_back(type);
    ++spec.nchannels;
  };
  const auto real = [&] {
    return chance(random, 0.5) ? OIIO::TypeDesc::HALF : OIIO::TypeDesc::FLOAT;
  };
  add("depth.Z", real());
  for (const char* name : {"normal.X", "normal.Y", "normal.Z"}) add(name, real());
  if (chance(random, 0.7)) add("objectId", OIIO::TypeDesc::UINT);
  if (chance(random, 0.5)) add("light0.visibility", real());
  if (chance(random, 0.3)) spec.tile_width = spec.tile_height = 16;
  if (chance(random, 0.2)) spec.x = spec.y = 3;
  spec.attribute("compression", kCompressions[below(random, std::size(kCompressions))]);
  spec.attribute("DateTime", "2000:01:01 00:00:00");  // not that of the day
  const bool flat = chance(random, 0.3);
  std::vector<float> pixels(spec.image_pixels() * static_cast<std::size_t>(spec.nchannels));
  for (float& value : pixels) value = flat ? 1.0f : random.real(0, 5);
  const auto output = OIIO::ImageOutput::create("openexr");
  if (!output || !output->open(file.string(), spec) ||
      !output->write_image(OIIO::TypeDesc::FLOAT, pixels.data()) || !output->close())
    return {};
  std::ifstream stream(file, std::ios::binary);
  return {width, height, {std::istreambuf_iterator<char>(stream), {}}};
}

/// Damage anywhere, or in the header alone, which has most of the ways to go wrong.
std::string damaged_file(const std::string& bytes, Random& random) {
  if (chance(random, 0.4)) return damaged(bytes, random, kWords);
  const std::size_t head = std::min<std::size_t>(bytes.size(), 420);
  return damaged(bytes.substr(0, head), random, kWords) + bytes.substr(head);
}

/// What is wrong with what the reader does; counts what it does.
std::string read(const std::filesystem::path& file, std::optional<ImageSize> size,
                 ReadOutcome& outcome) {
  try {
    const std::size_t announced = exr_planes(file, size).size();
    const PlaneSet planes = read_exr(file, size);
    ++outcome.accepted;
    if (planes.size() != announced) return "planes too many or too few";
    for (const Plane& plane : planes)
      if (size && (plane.width() != size->width || plane.height() != size->height))
        return "a plane has another size";
  } catch (const InputError& error) {
    ++outcome.refused;
    const std::string message = error.what();
    if (message.find(file.string()) == message.npos) return "no file in the message: " + message;
    if (message.size() > file.string().size() + kLongestMessage)
      return "a message of " + std::to_string(message.size()) + " bytes";
  } catch (const std::exception& error) {
    return std::string("it threw: ") + error.what();
  }
  return {};
}

/// What a file that passes the check of its header announces; 0 of others.
std::size_t image_bytes(const std::filesystem::path& file) {
  try {
    return check_exr_header(file).image_bytes();
  } catch (const InputError&) {
    return 0;
  }
}

}  // namespace

ReadOutcome fuzz_exr(std::uint32_t seed, const std::filesystem::path& folder) {
  ReadOutcome outcome;
  Random random(seed);
  const std::filesystem::path file = folder / "damaged.exr";
  const Sample sample = written(random, file);
  if (sample.bytes.empty()) return {"the file could not be written", 0, 0};
  const std::string bytes = damaged_file(sample.bytes, random);
  std::ofstream(file, std::ios::binary) << bytes;
  std::optional<ImageSize> size;
  if (chance(random, 0.5)) size = ImageSize{sample.width, sample.height};
  const PeakMemory peak(kMemoryLimit);
  outcome.problem = read(file, size, outcome);
  // The pixels as they lie in the file, the planes, and what the library keeps meanwhile.
  const std::size_t most = kMemoryBase + 3 * image_bytes(file);
  if (outcome.problem.empty() && peak.bytes() > most)
    outcome.problem =
        std::to_string(peak.bytes()) + " bytes for a file of " + std::to_string(bytes.size());
  return outcome;
}

}  // namespace holdfast::test
