#include "client/sequence/exr.h"

#include <cmath>
#include <fstream>
#include <limits>
#include <string>

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include "tests/sequence/expect_input_error.h"
#include "tests/sequence/temp_dir.h"

namespace holdfast {
namespace {

using test::expect_input_error;
using test::TempDir;

constexpr PlaneId kDepth{PlaneKind::kDepth, {}};
constexpr PlaneId kNormal{PlaneKind::kNormal, {}};
constexpr PlaneId kObjectId{PlaneKind::kObjectId, {}};

struct RawChannel {
  std::string name;
  OIIO::TypeDesc::BASETYPE type;
};

/// A file that another program wrote: any channels, every value `value`.
void write_raw(const std::filesystem::path& file, const std::vector<RawChannel>& channels,
               int width, int height, float value, int tile = 0, const char* compression = "zips") {
  OIIO::ImageSpec spec(width, height, static_cast<int>(channels.size()), OIIO::TypeDesc::FLOAT);
  spec.channelnames.clear();
  for (const RawChannel& channel : channels) {
    spec.channelnames.push_back(channel.name);
    spec.channelformats.emplace_back(channel.type);
  }
  spec.tile_width = spec.tile_height = tile;
  spec.attribute("compression", compression);
  const std::vector<float> pixels(static_cast<std::size_t>(width * height) * channels.size(),
                                  value);
  auto output = OIIO::ImageOutput::create("openexr");
  ASSERT_TRUE(output->open(file.string(), spec)) << output->geterror();
  ASSERT_TRUE(output->write_image(OIIO::TypeDesc::FLOAT, pixels.data())) << output->geterror();
  output->close();
}

PlaneSet sample_planes(int width, int height) {
  PlaneSet planes;
  Plane& depth = planes.add(kDepth, width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      depth.channel(0).at(x, y) = 0.1f + static_cast<float>(y * width + x);
  Plane& normal = planes.add(kNormal, width, height);
  for (int c = 0; c < 3; ++c) normal.channel(c).at(width - 1, height - 1) = static_cast<float>(c);
  planes.add(kObjectId, width, height).ids().at(0, 0) = 0xfedcba98u;
  return planes;
}

TEST(Exr, FloatPlanesComeBackBitForBit) {
  const TempDir dir;
  for (const auto& [width, height] : {std::pair{1, 1}, {1, 7}, {13, 1}, {67, 35}}) {
    PlaneSet planes = sample_planes(width, height);
    ChannelView<float> depth = planes.find(kDepth)->channel(0);
    depth.at(0, 0) = std::numeric_limits<float>::infinity();
    depth.at(width - 1, height - 1) = std::numeric_limits<float>::quiet_NaN();
    write_exr(dir / "a.exr", planes);
    const PlaneSet read = read_exr(dir / "a.exr");
    ASSERT_EQ(read.size(), planes.size());
    for (const Plane& plane : planes)
      for (int c = 0; c < plane.channels(); ++c)
        for (int y = 0; y < height; ++y)
          for (int x = 0; x < width; ++x)
            ASSERT_EQ(plane.words(c).at(x, y), read.at(plane.id()).words(c).at(x, y))
                << plane_name(plane.id()) << " at " << x << "," << y;
  }
}

TEST(Exr, IdsKeepAll32BitsBesideHalfReals) {
  const TempDir dir;
  PlaneSet planes = sample_planes(5, 3);
  write_exr(dir / "a.exr", planes, {.half = true});
  const PlaneSet read = read_exr(dir / "a.exr");
  EXPECT_EQ(read.at(kObjectId).ids().at(0, 0), 0xfedcba98u);
  EXPECT_EQ(read.at(kDepth).channel(0).at(0, 0), 0.0999755859375f);  // 0.1 rounded to half
}

TEST(Exr, EveryLosslessCompressionAndTilingReads) {
  const TempDir dir;
  for (const char* compression : {"none", "rle", "zips", "zip", "piz"})
    for (const int tile : {0, 16}) {
      write_raw(dir / "a.exr",
                {{"objectId", OIIO::TypeDesc::UINT},
                 {"depth.Z", OIIO::TypeDesc::FLOAT},
                 {"roughness", OIIO::TypeDesc::HALF}},
                37, 21, 1.0f, tile, compression);
      const PlaneSet read = read_exr(dir / "a.exr", ImageSize{37, 21});
      ASSERT_EQ(read.size(), 3u) << compression << " " << tile;
      EXPECT_EQ(read.at(kDepth).channel(0).at(36, 20), 1.0f) << compression << " " << tile;
      EXPECT_EQ(read.at({PlaneKind::kRoughness, {}}).channel(0).at(36, 20), 1.0f);
      EXPECT_EQ(read.at(kObjectId).ids().at(36, 20), 0xffffffffu);  // 1.0 as a normalised uint
    }
}

TEST(Exr, PlanesAreKnownFromTheHeaderAlone) {
  const TempDir dir;
  write_exr(dir / "a.exr", sample_planes(4, 4));
  EXPECT_EQ(exr_planes(dir / "a.exr").size(), 3u);
}

TEST(Exr, MissingFileIsNamed) {
  const TempDir dir;
  expect_input_error([&] { read_exr(dir / "frame.0003.exr"); }, {"frame.0003.exr", "missing"});
}

TEST(Exr, DamagedFileIsNamed) {
  const TempDir dir;
  std::ofstream(dir / "a.exr") << "this is no image";
  expect_input_error([&] { read_exr(dir / "a.exr"); }, {"a.exr", "readable EXR"});
}

TEST(Exr, TruncatedFileIsNamed) {
  const TempDir dir;
  write_exr(dir / "a.exr", sample_planes(64, 64));
  std::filesystem::resize_file(dir / "a.exr", std::filesystem::file_size(dir / "a.exr") / 2);
  expect_input_error([&] { read_exr(dir / "a.exr"); }, {"a.exr", "readable EXR"});
}

TEST(Exr, WrongSizeStatesBothSizes) {
  const TempDir dir;
  write_exr(dir / "a.exr", sample_planes(8, 5));
  expect_input_error([&] { read_exr(dir / "a.exr", ImageSize{8, 6}); }, {"a.exr", "8x6", "8x5"});
}

TEST(Exr, UnknownChannelIsNamed) {
  const TempDir dir;
  write_raw(dir / "a.exr", {{"depth.Z", OIIO::TypeDesc::FLOAT}, {"beauty.R", OIIO::TypeDesc::HALF}},
            4, 4, 1);
  expect_input_error([&] { read_exr(dir / "a.exr"); }, {"a.exr", "beauty.R", "unknown"});
}

TEST(Exr, IdThatIsNotUintIsNamed) {
  const TempDir dir;
  write_raw(dir / "a.exr", {{"objectId", OIIO::TypeDesc::FLOAT}}, 4, 4, 1);
  expect_input_error([&] { read_exr(dir / "a.exr"); }, {"objectId", "must be uint", "is float"});
}

TEST(Exr, RealThatIsUintIsNamed) {
  const TempDir dir;
  write_raw(dir / "a.exr", {{"depth.Z", OIIO::TypeDesc::UINT}}, 4, 4, 1);
  expect_input_error([&] { read_exr(dir / "a.exr"); },
                     {"depth.Z", "must be half or float", "is uint"});
}

TEST(Exr, PlaneWithoutAllItsChannelsIsNamed) {
  const TempDir dir;
  write_raw(dir / "a.exr",
            {{"normal.X", OIIO::TypeDesc::FLOAT}, {"normal.Y", OIIO::TypeDesc::FLOAT}}, 4, 4, 1);
  expect_input_error([&] { read_exr(dir / "a.exr"); }, {"a.exr", "normal.Z", "missing"});
}

TEST(Exr, PlanesOfDifferentSizesAreNotWritten) {
  const TempDir dir;
  PlaneSet planes;
  planes.add(kDepth, 4, 4);
  planes.add(kNormal, 4, 5);
  expect_input_error([&] { write_exr(dir / "a.exr", planes); }, {"normal", "4x4", "4x5"});
  expect_input_error([&] { write_exr(dir / "a.exr", {}); }, {"at least one plane"});
}

}  // namespace
}  // namespace holdfast
