#include "core/history/kept_images.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "tests/core/small_world.h"

namespace holdfast {
namespace {

constexpr int kWidth = 83, kHeight = 21;
const std::vector<KeptAs> kAll = {KeptAs::kHalf, KeptAs::kByte, KeptAs::kFineByte, KeptAs::kHalf,
                                  KeptAs::kFineByte};

Channels<float> noise(std::uint32_t seed) {
  test::Random random(seed);
  Channels<float> out(kWidth, kHeight, static_cast<int>(kAll.size()));
  for (int c = 0; c < out.count(); ++c)
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        out[c].at(x, y) = random.real(0.1f, 3.0f);
      }
  return out;
}

Channels<float> poisoned() {
  Channels<float> out(kWidth, kHeight, static_cast<int>(kAll.size()));
  for (int c = 0; c < out.count(); ++c)
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) out[c].at(x, y) = std::numeric_limits<float>::quiet_NaN();
  return out;
}

void expect_near(const Channels<float>& a, const Channels<float>& b, float half, float byte) {
  for (int c = 0; c < a.count(); ++c)
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        const bool is_half = kAll[static_cast<std::size_t>(c)] == KeptAs::kHalf;
        ASSERT_NEAR(a[c].at(x, y), b[c].at(x, y), (is_half ? half : byte) * std::abs(b[c].at(x, y)))
            << c << ' ' << x << ' ' << y;
      }
}

TEST(KeptImages, BringsBackWhatWasKeptIntoARoomWhateverTheRoomHeld) {
  const Channels<float> given = noise(3);
  for (const HistoryFormat format : {HistoryFormat::kPacked, HistoryFormat::kFloat}) {
    KeptImages kept(kWidth, kHeight, kAll, format);
    Channels<float> now = noise(3);
    kept.keep(now, 7);
    const bool packed = format == HistoryFormat::kPacked;
    expect_near(kept.copy(), given, packed ? 1e-3f : 0, packed ? 0.125f : 0);
    const Channels<float> copy = kept.copy();
    Channels<float> room = poisoned();
    kept.recall(room);
    expect_near(room, copy, 0, 0);
  }
}

TEST(KeptImages, OfAFreshHistoryAreZero) {
  for (const HistoryFormat format : {HistoryFormat::kPacked, HistoryFormat::kFloat}) {
    KeptImages kept(kWidth, kHeight, kAll, format);
    Channels<float> room = poisoned();
    kept.recall(room);
    expect_near(room, Channels<float>(kWidth, kHeight, 5), 0, 0);
  }
}

TEST(KeptImages, FloatsChangePlacesWithTheirRoom) {
  KeptImages kept(kWidth, kHeight, kAll, HistoryFormat::kFloat);
  const std::size_t bytes = kept.bytes();
  Channels<float> room, now = noise(1);
  kept.recall(room);
  EXPECT_EQ(room.bytes(), bytes);
  EXPECT_EQ(kept.bytes(), 0u);
  kept.keep(now, 0);
  EXPECT_EQ(kept.bytes(), bytes);
  EXPECT_EQ(now.bytes(), 0u);
}

TEST(KeptImages, ChannelsOfAPixelAreRoundedAlikeAndFramesAndPixelsEachInTheirOwnWay) {
  const std::vector<KeptAs> twice = {KeptAs::kHalf, KeptAs::kHalf, KeptAs::kByte, KeptAs::kByte};
  Channels<float> copies[2];
  for (const std::uint64_t key : {1u, 2u}) {
    KeptImages kept(kWidth, kHeight, twice, HistoryFormat::kPacked);
    Channels<float> now(kWidth, kHeight, 4);
    for (int c = 0; c < 4; ++c)
      for (int y = 0; y < kHeight; ++y) std::fill_n(now[c].row(y), kWidth, 0.7654321f);
    kept.keep(now, key);
    copies[key - 1] = kept.copy();
  }
  int other_frame = 0, other_pixel = 0;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 1; x < kWidth; ++x) {
      const Channels<float>& a = copies[0];
      ASSERT_EQ(a[0].at(x, y), a[1].at(x, y));
      ASSERT_EQ(a[2].at(x, y), a[3].at(x, y));
      other_frame += a[2].at(x, y) != copies[1][2].at(x, y);
      other_pixel += a[2].at(x, y) != a[2].at(x - 1, y);
    }
  // It lies 0.247 of a step above a byte: two draws differ with probability 2 * 0.247 * 0.753.
  const double pairs = kHeight * (kWidth - 1);
  EXPECT_NEAR(other_frame / pairs, 0.372, 0.05);
  EXPECT_NEAR(other_pixel / pairs, 0.372, 0.05);
}

TEST(KeptImages, OfNoHistoryHoldNothing) {
  KeptImages kept(kWidth, kHeight, kAll, HistoryFormat::kNone);
  EXPECT_EQ(kept.bytes(), 0u);
  Channels<float> now = noise(1);
  kept.keep(now, 0);
  expect_near(now, noise(1), 0, 0);
}

TEST(KeptImages, PackedTakeTwoBytesAHalfAndOneAByte) {
  const KeptImages kept(1920, 16, kAll, HistoryFormat::kPacked);
  const double pixel = static_cast<double>(kept.bytes()) / (1920 * 16);
  EXPECT_GE(pixel, 2 * 2 + 3);
  EXPECT_LT(pixel, 2 * 2 + 3 + 0.2) << "an exponent for 64 values, and what rows are padded by";
}

TEST(KeptImages, AreTheSameBitsOnAnyNumberOfThreads) {
  Channels<float> copies[2];
  for (const int threads : {1, 4}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(threads));
    KeptImages kept(kWidth, kHeight, kAll, HistoryFormat::kPacked);
    Channels<float> now = noise(4);
    kept.keep(now, 5);
    copies[threads == 1 ? 0 : 1] = kept.copy();
  }
  expect_near(copies[0], copies[1], 0, 0);
}

}  // namespace
}  // namespace holdfast
