#include "proto/codec.h"

#include <lz4.h>
#include <zstd.h>

#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace holdfast::wire {
namespace {

std::vector<std::byte> smooth(std::size_t count) {
  std::vector<std::byte> bytes(count);
  for (std::size_t i = 0; i < count; ++i) bytes[i] = static_cast<std::byte>(i / 97);
  return bytes;
}

std::vector<std::byte> noise(std::size_t count) {
  std::mt19937 random(1);
  std::vector<std::byte> bytes(count);
  for (std::byte& byte : bytes) byte = static_cast<std::byte>(random());
  return bytes;
}

std::string compressed(BlockCodec& codec, Codec kind, const std::vector<std::byte>& bytes) {
  std::string out(bytes.size(), '\0');
  out.resize(
      codec.compress(kind, bytes.data(), bytes.size(), reinterpret_cast<std::byte*>(out.data())));
  return out;
}

class EachCodec : public ::testing::TestWithParam<Codec> {
 protected:
  bool decompress(const std::string& in, std::size_t bytes) {
    out.assign(bytes + 16, std::byte{0xaa});
    const bool good = codec.decompress(GetParam(), in, out.data(), bytes);
    for (std::size_t i = bytes; i < out.size(); ++i)
      EXPECT_EQ(out[i], std::byte{0xaa}) << "wrote beyond the block";
    out.resize(bytes);
    return good;
  }

  BlockCodec codec;
  std::vector<std::byte> out;
};

TEST_P(EachCodec, RestoresWhatItMadeSmaller) {
  for (const std::size_t size : {100u, 4096u, 1u << 20}) {
    const auto bytes = smooth(size);
    const std::string small = compressed(codec, GetParam(), bytes);
    ASSERT_GT(small.size(), 0u);
    ASSERT_LT(small.size(), size);
    ASSERT_TRUE(decompress(small, size));
    EXPECT_TRUE(out == bytes);
  }
}

TEST_P(EachCodec, SaysThatNoiseDoesNotGetSmaller) {
  EXPECT_EQ(compressed(codec, GetParam(), noise(100000)), "");
  EXPECT_EQ(compressed(codec, GetParam(), noise(1)), "");
}

TEST_P(EachCodec, RefusesBlocksOfAnotherSize) {
  const std::string small = compressed(codec, GetParam(), smooth(5000));
  EXPECT_FALSE(decompress(small, 4999));
  EXPECT_FALSE(decompress(small, 5001));
  EXPECT_FALSE(decompress(small, 0));
}

TEST_P(EachCodec, RefusesEveryTruncation) {
  const std::string small = compressed(codec, GetParam(), smooth(5000));
  for (std::size_t length = 0; length < small.size(); ++length)
    ASSERT_FALSE(decompress(small.substr(0, length), 5000)) << length;
}

TEST_P(EachCodec, SurvivesDamageOfEveryByte) {
  const std::string small = compressed(codec, GetParam(), smooth(20000));
  std::mt19937 random(2);
  for (std::size_t i = 0; i < small.size(); ++i) {
    std::string damaged = small;
    damaged[i] = static_cast<char>(damaged[i] ^ static_cast<char>(1 + random() % 255));
    decompress(damaged, 20000);  // refused or wrong, never out of bounds
  }
  for (int i = 0; i < 2000; ++i) {
    std::string junk(random() % 300, '\0');
    for (char& c : junk) c = static_cast<char>(random());
    decompress(junk, 20000);
  }
}

TEST_P(EachCodec, StopsABombAtTheBlocksSize) {
  constexpr std::size_t kHuge = 16u << 20;
  const std::vector<std::byte> zeros(kHuge);
  const std::string bomb = compressed(codec, GetParam(), zeros);
  ASSERT_LT(bomb.size(), kHuge / 200);
  EXPECT_FALSE(decompress(bomb, 4096));
}

INSTANTIATE_TEST_SUITE_P(Codecs, EachCodec, ::testing::Values(Codec::kLz4, Codec::kZstd),
                         [](const auto& codec) { return std::string(codec_name(codec.param)); });

TEST(Codecs, WriteWhatTheLibrariesRead) {
  BlockCodec codec;
  const auto bytes = smooth(10000);
  std::vector<char> out(bytes.size());
  const std::string lz4 = compressed(codec, Codec::kLz4, bytes);
  EXPECT_EQ(LZ4_decompress_safe(lz4.data(), out.data(), static_cast<int>(lz4.size()), 10000),
            10000);
  const std::string zstd = compressed(codec, Codec::kZstd, bytes);
  EXPECT_EQ(ZSTD_getFrameContentSize(zstd.data(), zstd.size()), 10000u);
  EXPECT_EQ(ZSTD_decompress(out.data(), out.size(), zstd.data(), zstd.size()), 10000u);
}

TEST(Codecs, NoneNeitherCompressesNorDecompresses) {
  BlockCodec codec;
  std::vector<std::byte> out(100);
  EXPECT_EQ(compressed(codec, Codec::kNone, smooth(100)), "");
  EXPECT_FALSE(codec.decompress(Codec::kNone, "abc", out.data(), 100));
  EXPECT_EQ(codec_from_number(0), Codec::kNone);
  EXPECT_EQ(codec_from_number(2), Codec::kZstd);
  EXPECT_EQ(codec_from_number(3), std::nullopt);
  EXPECT_EQ(codec_from_number(-1), std::nullopt);
}

}  // namespace
}  // namespace holdfast::wire
