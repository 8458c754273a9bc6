#include "core/history/half_block.h"

#include <bit>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "tests/core/isa_guard.h"

namespace holdfast {
namespace {

/// The value of a finite half, by its definition.
double value_of(std::uint16_t half) {
  const int exponent = (half >> 10) & 31, mantissa = half & 1023;
  const double magnitude =
      exponent == 0 ? std::ldexp(mantissa, -24) : std::ldexp(1024 + mantissa, exponent - 25);
  return (half & 0x8000) ? -magnitude : magnitude;
}

struct Packed {
  std::uint16_t halves[kHalfBlock] = {};
  std::int8_t exponent = 0;
};

Packed pack(const std::vector<float>& values, std::uint32_t seed) {
  Packed out;
  std::uint32_t random[kHalfBlock];
  for (std::uint32_t& bits : random) bits = (seed = seed * 1664525u + 1013904223u) >> 8;
  pack_half_block(
      {values.data(), static_cast<int>(values.size()), random, out.halves, &out.exponent});
  return out;
}

std::vector<float> unpack(const Packed& packed, int count) {
  std::vector<float> out(kHalfBlock);
  unpack_half_block({packed.halves, count, packed.exponent, out.data()});
  out.resize(static_cast<std::size_t>(count));
  return out;
}

/// Values that look random, of every size of so many octaves below 2^13 and either sign.
std::vector<float> mixed_values(std::uint32_t seed, int count, unsigned octaves = 33) {
  std::vector<float> out;
  for (int i = 0; i < count; ++i) {
    seed = seed * 1664525u + 1013904223u;
    const int exponent = 12 - static_cast<int>((seed >> 21) % octaves);
    const float value = std::ldexp(1.0f + static_cast<float>(seed & 0xfffff) * 0x1p-20f, exponent);
    out.push_back((seed >> 26) & 1 ? -value : value);
  }
  return out;
}

TEST(HalfBlock, EveryHalfBelowTheGreatestSurvivesTheRoundTripOnEveryInstructionSet) {
  const test::IsaGuard guard;
  for (const Isa isa : available_isas()) {
    select_isa(isa);
    std::vector<std::uint16_t> all;
    for (unsigned half = 0; half < 0x10000; ++half)
      if (((half >> 10) & 31) < 29) all.push_back(static_cast<std::uint16_t>(half));
    for (std::size_t first = 0; first < all.size(); first += kHalfBlock - 1) {
      Packed given;
      const std::size_t count = std::min<std::size_t>(kHalfBlock - 1, all.size() - first);
      for (std::size_t i = 0; i < count; ++i) given.halves[i] = all[first + i];
      given.halves[count] = 0x7400;  // 2^14, so that the block needs no power of two
      const int size = static_cast<int>(count) + 1;
      const std::vector<float> values = unpack(given, size);
      for (std::size_t i = 0; i < count; ++i)
        ASSERT_EQ(static_cast<double>(values[i]), value_of(given.halves[i])) << given.halves[i];
      const Packed again = pack(values, static_cast<std::uint32_t>(first));
      ASSERT_EQ(again.exponent, 0);
      for (int i = 0; i < size; ++i) ASSERT_EQ(again.halves[i], given.halves[i]) << isa_name(isa);
    }
  }
}

TEST(HalfBlock, RoundsToOneOfTheTwoHalvesAroundAValueAndKeepsTheMean) {
  const std::vector<float> values = mixed_values(5, kHalfBlock, 44);  // some below the least half
  std::vector<double> sums(kHalfBlock);
  constexpr int kDraws = 4000;
  const int least = -24 - pack(values, 0).exponent;
  const auto step_of = [&](float v) {
    return std::ldexp(1.0, std::max(std::ilogb(v) - 10, least));
  };
  for (std::uint32_t seed = 0; seed < kDraws; ++seed) {
    const std::vector<float> rounded = unpack(pack(values, seed * 2654435761u), kHalfBlock);
    for (std::size_t i = 0; i < sums.size(); ++i) {
      const double step = step_of(values[i]);
      ASSERT_LT(std::abs(double{rounded[i]} - double{values[i]}), step);
      sums[i] += double{rounded[i]};
    }
  }
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const double step = step_of(values[i]);
    // Five standard errors of a mean of draws between two halves.
    EXPECT_NEAR(sums[i] / kDraws, double{values[i]}, 5 * 0.5 * step / std::sqrt(kDraws)) << i;
  }
}

TEST(HalfBlock, EveryInstructionSetWritesTheSameBits) {
  const test::IsaGuard guard;
  for (const int count : {1, 7, 16, 33, 64})
    for (std::uint32_t seed = 1; seed < 200; ++seed) {
      const std::vector<float> values = mixed_values(seed, count);
      select_isa(Isa::kScalar);
      const Packed expected = pack(values, seed);
      const std::vector<float> back = unpack(expected, count);
      for (const Isa isa : available_isas()) {
        select_isa(isa);
        const Packed packed = pack(values, seed);
        ASSERT_EQ(packed.exponent, expected.exponent);
        for (int i = 0; i < count; ++i) ASSERT_EQ(packed.halves[i], expected.halves[i]);
        ASSERT_EQ(unpack(packed, count), back) << isa_name(isa);
      }
    }
}

TEST(HalfBlock, NoScaleIsOutOfRangeAndPowersOfTwoChangeNoBit) {
  const std::vector<float> values = mixed_values(9, kHalfBlock);
  const Packed expected = pack(values, 3);
  for (const int scale : {-80, -40, -1, 1, 20, 60, 100}) {
    std::vector<float> scaled = values;
    for (float& value : scaled) value = std::ldexp(value, scale);
    const Packed packed = pack(scaled, 3);
    EXPECT_EQ(packed.exponent, expected.exponent - scale);
    for (int i = 0; i < kHalfBlock; ++i) ASSERT_EQ(packed.halves[i], expected.halves[i]) << scale;
  }
  const std::vector<float> extremes = {1e30f, 0.0f, -1e30f, 1e25f, 1e-30f};
  const std::vector<float> back = unpack(pack(extremes, 1), 5);
  EXPECT_NEAR(back[0] / 1e30f, 1.0f, 1e-3f);
  EXPECT_EQ(back[1], 0.0f);
  EXPECT_NEAR(back[2] / 1e30f, -1.0f, 1e-3f);
  EXPECT_NEAR(back[3] / 1e25f, 1.0f, 1e-3f);
  EXPECT_EQ(back[4], 0.0f) << "2^-39 of the greatest";
  for (const float zero : unpack(pack(std::vector<float>(9, 0.0f), 1), 9)) EXPECT_EQ(zero, 0.0f);
}

// With each sample, a mean of weight 1/64 moves by a 64th of the difference: rounding to the
// nearest half would stand still wherever that is less than half a step.
TEST(HalfBlock, AMeanOfManySamplesDoesNotStall) {
  std::vector<float> mean(kHalfBlock, 1.0f);
  constexpr float kSample = 1.02f;  // a 64th of the difference is a third of a step
  double late = 0;
  for (std::uint32_t frame = 0; frame < 1200; ++frame) {
    for (float& value : mean) value += (kSample - value) / 64.0f;
    mean = unpack(pack(mean, frame * 747796405u), kHalfBlock);
    if (frame < 1000) continue;
    for (const float value : mean) late += double{value} / (200 * kHalfBlock);
  }
  EXPECT_NEAR(late, double{kSample}, 2e-4);
}

}  // namespace
}  // namespace holdfast
