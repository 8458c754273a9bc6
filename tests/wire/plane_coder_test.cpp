#include "proto/plane_coder.h"

#include <cstring>
#include <random>

#include <gtest/gtest.h>

#include "core/frame/error.h"

namespace holdfast::wire {
namespace {

constexpr int kWidth = 701, kHeight = 503;  // more than one block of 1 MiB, rows that blocks cut

/// A plane whose values each format holds, smooth enough for codecs.
Plane test_plane(PlaneKind kind, int width = kWidth, int height = kHeight) {
  Plane plane({kind, {}}, width, height);
  for (int c = 0; c < plane.channels(); ++c)
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        if (plane.is_uint())
          plane.ids().at(x, y) = static_cast<std::uint32_t>(x / 100 + y / 10) % 256;
        else
          plane.channel(c).at(x, y) = static_cast<float>((x / 8 * (c + 1) + y) % 256) / 255.0f;
      }
  return plane;
}

struct Block {
  std::size_t offset, bytes;
  std::string data;
};

std::vector<Block> blocks_of(const Plane& plane, PlaneCoding coding) {
  PlaneCoder coder;
  std::vector<Block> blocks;
  for (std::size_t offset = 0; offset < plane_bytes(plane, coding.format);) {
    Block block{offset, 0, {}};
    block.bytes = coder.encode(plane, coding, offset, block.data);
    offset += block.bytes;
    blocks.push_back(std::move(block));
  }
  return blocks;
}

bool same(const Plane& a, const Plane& b) {
  for (int c = 0; c < a.channels(); ++c)
    for (int y = 0; y < a.height(); ++y)
      if (std::memcmp(a.words(c).row(y), b.words(c).row(y),
                      4 * static_cast<std::size_t>(a.width())) != 0)
        return false;
  return true;
}

const std::vector<PlaneKind> kKinds{PlaneKind::kDepth, PlaneKind::kNormal, PlaneKind::kObjectId,
                                    PlaneKind::kIndirect, PlaneKind::kMotion};

std::vector<PlaneCoding> codings_of(PlaneKind kind) {
  std::vector<PlaneCoding> codings;
  for (int format = 1; format <= 9; ++format)
    for (const Codec codec : {Codec::kNone, Codec::kLz4, Codec::kZstd})
      if (format_from_number(format, kind))
        codings.push_back({static_cast<PlaneFormat>(format), codec});
  return codings;
}

TEST(PlaneCoder, BlocksTogetherRestoreThePlaneInEveryCoding) {
  for (const PlaneKind kind : kKinds) {
    const Plane plane = test_plane(kind);
    for (const PlaneCoding coding : codings_of(kind)) {
      // What the format makes of the values, in one piece and without a codec.
      Plane expected(plane.id(), kWidth, kHeight), found(plane.id(), kWidth, kHeight);
      std::vector<std::byte> bytes(plane_bytes(plane, coding.format));
      read_plane_bytes(plane, coding.format, 0, bytes.size(), bytes.data());
      write_plane_bytes(expected, coding.format, 0, bytes.size(), bytes.data());
      PlaneCoder coder;
      for (const Block& block : blocks_of(plane, coding)) {
        EXPECT_LE(block.bytes, kMaxChunkBytes);
        EXPECT_LE(block.data.size(), block.bytes);
        ASSERT_TRUE(coder.decode(found, coding, block.offset, block.bytes, block.data));
      }
      EXPECT_TRUE(same(found, expected))
          << plane_name(plane.id()) << " " << format_name(coding.format) << " "
          << codec_name(coding.codec);
    }
  }
}

TEST(PlaneCoder, FullFormatsRestoreEveryBitWithAnyCodec) {
  for (const PlaneKind kind : kKinds) {
    Plane plane = test_plane(kind);
    std::mt19937 random(1);
    for (int x = 0; x < kWidth; ++x) plane.words(0).at(x, 3) = static_cast<std::uint32_t>(random());
    for (const Codec codec : {Codec::kNone, Codec::kLz4, Codec::kZstd}) {
      Plane found(plane.id(), kWidth, kHeight);
      PlaneCoder coder;
      const PlaneCoding coding{full_format(kind), codec};
      for (const Block& block : blocks_of(plane, coding))
        ASSERT_TRUE(coder.decode(found, coding, block.offset, block.bytes, block.data));
      EXPECT_TRUE(same(found, plane));
    }
  }
}

TEST(PlaneCoder, FullFormatWithoutCodecIsThePlanesWordsInOrder) {
  const Plane plane = test_plane(PlaneKind::kNormal, 5, 3);
  const auto blocks = blocks_of(plane, full_coding(PlaneKind::kNormal));
  ASSERT_EQ(blocks.size(), 1u);
  ASSERT_EQ(blocks[0].data.size(), 3u * 5u * 3u * 4u);
  std::size_t at = 0;
  for (int c = 0; c < 3; ++c)
    for (int y = 0; y < 3; ++y)
      for (int x = 0; x < 5; ++x, at += 4) {
        std::uint32_t word = 0;
        std::memcpy(&word, blocks[0].data.data() + at, 4);
        ASSERT_EQ(word, plane.words(c).at(x, y));
      }
}

TEST(PlaneCoder, NoiseTravelsAsItIsUnderACodec) {
  Plane plane({PlaneKind::kDepth, {}}, 64, 64);
  std::mt19937 random(2);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) plane.words(0).at(x, y) = static_cast<std::uint32_t>(random());
  for (const Codec codec : {Codec::kLz4, Codec::kZstd}) {
    const PlaneCoding coding{PlaneFormat::kF32, codec};
    const auto blocks = blocks_of(plane, coding);
    ASSERT_EQ(blocks[0].data.size(), blocks[0].bytes);
    Plane found(plane.id(), 64, 64);
    ASSERT_TRUE(PlaneCoder().decode(found, coding, 0, blocks[0].bytes, blocks[0].data));
    EXPECT_TRUE(same(found, plane));
  }
}

TEST(PlaneCoder, DamagedBlocksLeaveThePlaneAlone) {
  const Plane plane = test_plane(PlaneKind::kDepth, 64, 64);
  for (const Codec codec : {Codec::kLz4, Codec::kZstd}) {
    const PlaneCoding coding{PlaneFormat::kF16, codec};
    const Block block = blocks_of(plane, coding)[0];
    ASSERT_LT(block.data.size(), block.bytes);
    Plane found(plane.id(), 64, 64);
    PlaneCoder coder;
    EXPECT_FALSE(coder.decode(found, coding, 0, block.bytes, ""));
    EXPECT_FALSE(coder.decode(found, coding, 0, block.bytes, block.data.substr(1)));
    EXPECT_FALSE(coder.decode(found, coding, 0, block.bytes - 2, block.data));
    EXPECT_TRUE(same(found, Plane(plane.id(), 64, 64)));
    EXPECT_TRUE(coder.decode(found, coding, 0, block.bytes, block.data)) << "goes on";
  }
}

TEST(PlaneCoder, NumbersThatDoNotSuitThePlaneAreRefusedByName) {
  const PlaneId depth{PlaneKind::kDepth, {}};
  EXPECT_EQ(coding_from_numbers(depth, 2, 1), (PlaneCoding{PlaneFormat::kF16, Codec::kLz4}));
  try {
    coding_from_numbers(depth, 7, 0);
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "format of plane depth must be one that suits the plane, but it is 7");
  }
  try {
    coding_from_numbers(depth, 0, 9);
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "codec of plane depth must be a known one, but it is 9");
  }
}

}  // namespace
}  // namespace holdfast::wire
