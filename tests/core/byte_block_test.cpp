#include "core/history/byte_block.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "tests/core/isa_guard.h"

namespace holdfast {
namespace {

struct Packed {
  std::uint8_t bytes[kByteBlock] = {};
  std::int8_t exponent = 0;
};

Packed pack(const std::vector<float>& values, ByteKind kind, std::uint32_t seed) {
  Packed out;
  std::uint32_t random[kByteBlock];
  for (std::uint32_t& bits : random) bits = (seed = seed * 1664525u + 1013904223u) >> 8;
  pack_byte_block(
      {values.data(), static_cast<int>(values.size()), kind, random, out.bytes, &out.exponent});
  return out;
}

std::vector<float> unpack(const Packed& packed, ByteKind kind, int count) {
  std::vector<float> out(static_cast<std::size_t>(count));
  unpack_byte_block({packed.bytes, count, kind, packed.exponent, out.data()});
  return out;
}

constexpr ByteKind kKinds[] = {ByteKind::kPlain, ByteKind::kFine};

int steps_of(ByteKind kind) { return kind == ByteKind::kFine ? 32 : 8; }

/// The value of a byte, by its definition: so many steps an octave, counted down from 2.
double value_of(std::uint8_t byte, ByteKind kind) {
  if (byte == 0) return 0;
  const int below = 255 - byte, steps = steps_of(kind);  // 0: exactly 2
  return std::ldexp(1.0 + static_cast<double>((steps - below % steps) % steps) / steps,
                    1 - (below + steps - 1) / steps);
}

TEST(ByteBlock, EveryByteSurvivesTheRoundTripOnEveryInstructionSet) {
  const test::IsaGuard guard;
  for (const Isa isa : available_isas()) {
    select_isa(isa);
    for (const ByteKind kind : kKinds)
      for (int first = 0; first < 256; first += 32) {
        Packed given;
        std::vector<float> values;
        for (int i = 0; i < 32; ++i) given.bytes[i] = static_cast<std::uint8_t>(first + i);
        given.bytes[32] = static_cast<std::uint8_t>(
            255 - steps_of(kind));  // 1, so that the block needs no power of two
        values = unpack(given, kind, 33);
        for (int i = 0; i < 33; ++i)
          ASSERT_EQ(double{values[static_cast<std::size_t>(i)]}, value_of(given.bytes[i], kind))
              << int{given.bytes[i]};
        for (float& value : values)  // 2 is what rounding up leads to, no greatest value
          if (value >= 2.0f) value = 1.0f;
        const Packed again = pack(values, kind, 77u * static_cast<std::uint32_t>(first));
        EXPECT_EQ(again.exponent, 0);
        EXPECT_EQ(unpack(again, kind, 33), values) << isa_name(isa);
      }
  }
}

TEST(ByteBlock, RoundsToANeighbourAndKeepsTheMean) {
  for (const ByteKind kind : kKinds) {
    std::vector<float> values;
    for (int i = 0; i < kByteBlock; ++i)
      values.push_back(
          std::exp2((kind == ByteKind::kFine ? -0.09f : -0.17f) * static_cast<float>(i)) * 1.7f);
    const double step = 1.0 / steps_of(kind);  // at most, of a value
    std::vector<double> sums(kByteBlock);
    constexpr int kDraws = 4000;
    for (std::uint32_t seed = 0; seed < kDraws; ++seed) {
      const auto rounded = unpack(pack(values, kind, seed * 2654435761u), kind, kByteBlock);
      for (std::size_t i = 0; i < sums.size(); ++i) {
        ASSERT_LT(double{std::abs(rounded[i] - values[i])}, step * double{values[i]});
        sums[i] += double{rounded[i]};
      }
    }
    for (std::size_t i = 0; i < sums.size(); ++i)
      EXPECT_NEAR(sums[i] / kDraws, double{values[i]},
                  2.5 * step * double{values[i]} / std::sqrt(kDraws))
          << i;
  }
}

TEST(ByteBlock, WhatIsFarBelowTheGreatestBecomesZeroAndZeroStaysZero) {
  const std::vector<float> values = {1e20f, 0.0f, 1e10f, 1e12f, 1.0f};
  const std::vector<float> back = unpack(pack(values, ByteKind::kPlain, 5), ByteKind::kPlain, 5);
  EXPECT_NEAR(back[0] / 1e20f, 1.0f, 0.125f);
  EXPECT_EQ(back[1], 0.0f);
  EXPECT_EQ(back[2], 0.0f) << "2^-33";
  EXPECT_NEAR(back[3] / 1e12f, 1.0f, 0.125f) << "2^-27";
  EXPECT_EQ(back[4], 0.0f);
}

}  // namespace
}  // namespace holdfast
