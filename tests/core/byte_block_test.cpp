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

Packed pack(const std::vector<float>& values, bool with_sign, std::uint32_t seed) {
  Packed out;
  std::uint32_t random[kByteBlock];
  for (std::uint32_t& bits : random) bits = (seed = seed * 1664525u + 1013904223u) >> 8;
  pack_byte_block({values.data(), static_cast<int>(values.size()), with_sign, random, out.bytes,
                   &out.exponent});
  return out;
}

std::vector<float> unpack(const Packed& packed, bool with_sign, int count) {
  std::vector<float> out(static_cast<std::size_t>(count));
  unpack_byte_block({packed.bytes, count, with_sign, packed.exponent, out.data()});
  return out;
}

/// The value of a byte, by its definition: three bits of mantissa, counted down from 2.
double value_of(std::uint8_t byte, bool with_sign) {
  const int greatest = with_sign ? 127 : 255, code = with_sign ? byte & 127 : byte;
  if (code == 0) return 0;
  const int below = greatest - code;  // 0: exactly 2
  const double magnitude = std::ldexp(1.0 + ((8 - below % 8) % 8) / 8.0, 1 - (below + 7) / 8);
  return with_sign && byte > 127 ? -magnitude : magnitude;
}

TEST(ByteBlock, EveryByteSurvivesTheRoundTripOnEveryInstructionSet) {
  const test::IsaGuard guard;
  for (const Isa isa : available_isas()) {
    select_isa(isa);
    for (const bool with_sign : {false, true})
      for (int first = 0; first < 256; first += 32) {
        Packed given;
        std::vector<float> values;
        for (int i = 0; i < 32; ++i) given.bytes[i] = static_cast<std::uint8_t>(first + i);
        given.bytes[32] = with_sign ? 119 : 247;  // 1, so that the block needs no power of two
        values = unpack(given, with_sign, 33);
        for (int i = 0; i < 33; ++i)
          ASSERT_EQ(double{values[static_cast<std::size_t>(i)]},
                    value_of(given.bytes[i], with_sign))
              << int{given.bytes[i]};
        for (float& value : values)  // 2 and -2 are what rounding up leads to, no greatest value
          if (std::abs(value) >= 2.0f) value = 1.0f;
        const Packed again = pack(values, with_sign, 77u * static_cast<std::uint32_t>(first));
        EXPECT_EQ(again.exponent, 0);
        EXPECT_EQ(unpack(again, with_sign, 33), values) << isa_name(isa);
      }
  }
}

TEST(ByteBlock, RoundsToANeighbourAndKeepsTheMean) {
  for (const bool with_sign : {false, true}) {
    std::vector<float> values;
    for (int i = 0; i < kByteBlock; ++i)
      values.push_back(std::exp2(-0.17f * static_cast<float>(i)) *
                       (with_sign && i % 3 == 0 ? -1.7f : 1.7f));
    std::vector<double> sums(kByteBlock);
    constexpr int kDraws = 4000;
    for (std::uint32_t seed = 0; seed < kDraws; ++seed) {
      const auto rounded =
          unpack(pack(values, with_sign, seed * 2654435761u), with_sign, kByteBlock);
      for (std::size_t i = 0; i < sums.size(); ++i) {
        ASSERT_LT(std::abs(rounded[i] - values[i]), 0.125f * std::abs(values[i])) << i;
        sums[i] += double{rounded[i]};
      }
    }
    for (std::size_t i = 0; i < sums.size(); ++i)
      EXPECT_NEAR(sums[i] / kDraws, double{values[i]},
                  5 * 0.0625 * std::abs(double{values[i]}) / std::sqrt(kDraws))
          << i;
  }
}

TEST(ByteBlock, WhatIsFarBelowTheGreatestBecomesZeroAndZeroStaysZero) {
  const std::vector<float> values = {1e20f, 0.0f, 1e10f, 1e12f, 1.0f};
  const std::vector<float> back = unpack(pack(values, false, 5), false, 5);
  EXPECT_NEAR(back[0] / 1e20f, 1.0f, 0.125f);
  EXPECT_EQ(back[1], 0.0f);
  EXPECT_EQ(back[2], 0.0f) << "2^-33";
  EXPECT_NEAR(back[3] / 1e12f, 1.0f, 0.125f) << "2^-27";
  EXPECT_EQ(back[4], 0.0f);
}

}  // namespace
}  // namespace holdfast
