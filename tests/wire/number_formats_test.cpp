// Each format against its definition in double precision, stated here by itself.
#include "proto/number_formats.h"

#include <array>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "proto/format_rows.h"
#include "tests/core/isa_guard.h"

namespace holdfast::wire {
namespace {

/// The real value of a half; NaN and infinities by their code.
double value_of_half(std::uint32_t code) {
  const double sign = code & 0x8000u ? -1.0 : 1.0;
  const int exponent = static_cast<int>((code >> 10) & 31u);
  const double mantissa = code & 1023u;
  if (exponent == 31)
    return mantissa > 0 ? std::numeric_limits<double>::quiet_NaN()
                        : sign * std::numeric_limits<double>::infinity();
  if (exponent == 0) return sign * std::ldexp(mantissa, -24);
  return sign * std::ldexp(1024.0 + mantissa, exponent - 25);
}

/// `v` rounded to a multiple of the half's step at its place, ties to even.
double rounded_to_half(double v) {
  if (!std::isfinite(v) || v == 0.0) return v;
  const int exponent = std::max(-14, static_cast<int>(std::floor(std::log2(std::abs(v)))));
  const double rounded = std::ldexp(std::nearbyint(std::ldexp(v, 10 - exponent)), exponent - 10);
  return std::abs(rounded) > 65504.0 ? std::copysign(INFINITY, v) : rounded;
}

TEST(Half, EveryValueRoundTrips) {
  for (std::uint32_t code = 0; code < 65536; ++code) {
    const float value = from_half(static_cast<std::uint16_t>(code));
    const double expected = value_of_half(code);
    if (std::isnan(expected)) {
      EXPECT_TRUE(std::isnan(value)) << code;
      EXPECT_EQ(half_of(value) & 0x7fffu, 0x7e00u) << code;
    } else {
      ASSERT_EQ(static_cast<double>(value), expected) << code;
      ASSERT_EQ(std::signbit(value), (code & 0x8000u) != 0) << code;
      ASSERT_EQ(half_of(value), code);
    }
  }
}

TEST(Half, IsTheNearestOneTiesToEven) {
  std::mt19937 random(1);
  for (int i = 0; i < 2000000; ++i) {
    const auto v = std::bit_cast<float>(static_cast<std::uint32_t>(random()));
    if (std::isnan(v)) continue;
    ASSERT_EQ(static_cast<double>(from_half(half_of(v))), rounded_to_half(v)) << v;
  }
  for (std::uint32_t code = 0; code < 0x7bff; ++code) {  // halfway between neighbours
    const double tie = 0.5 * (value_of_half(code) + value_of_half(code + 1));
    const float at = from_half(half_of(static_cast<float>(tie)));
    ASSERT_EQ(static_cast<double>(at), value_of_half(code % 2 == 0 ? code : code + 1)) << code;
  }
}

TEST(Half, OverflowsFromHalfwayBeyondItsLargestValue) {
  EXPECT_EQ(from_half(half_of(65519.99f)), 65504.0f);
  EXPECT_EQ(from_half(half_of(65520.0f)), INFINITY);
  EXPECT_EQ(from_half(half_of(-1e30f)), -INFINITY);
  EXPECT_EQ(half_of(-0.0f), 0x8000u);
}

TEST(Unorm, EveryCodeRoundTripsAndBothEndsAreExact) {
  for (const std::uint32_t most : {255u, 65535u}) {
    const auto scale = static_cast<float>(most);
    for (std::uint32_t code = 0; code <= most; ++code)
      ASSERT_EQ(unorm_of(from_unorm(code, scale), scale), code);
    EXPECT_EQ(from_unorm(0, scale), 0.0f);
    EXPECT_EQ(from_unorm(most, scale), 1.0f);
  }
}

TEST(Unorm, ErrorIsAtMostHalfAStepAndNothingLeavesTheRange) {
  std::mt19937 random(2);
  std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
  for (const float most : {255.0f, 65535.0f})
    for (int i = 0; i < 200000; ++i) {
      const float v = uniform(random);
      ASSERT_LE(std::abs(static_cast<double>(from_unorm(unorm_of(v, most), most)) -
                         static_cast<double>(v)),
                0.5001 / static_cast<double>(most) + 6e-8);
    }
  EXPECT_EQ(unorm_of(-3.0f, 255.0f), 0u);
  EXPECT_EQ(unorm_of(7.0f, 255.0f), 255u);
  EXPECT_EQ(unorm_of(INFINITY, 65535.0f), 65535u);
  EXPECT_EQ(unorm_of(NAN, 255.0f), 0u);
}

/// EXT_texture_shared_exponent's text, N = 9, B = 15, Emax = 31, in double.
std::uint32_t defined_rgb9e5(const std::array<double, 3>& rgb) {
  const double largest = 511.0 / 512.0 * 65536.0;
  std::array<double, 3> c;
  for (std::size_t i = 0; i < 3; ++i) c[i] = std::max(0.0, std::min(largest, rgb[i]));
  const double most = std::max({c[0], c[1], c[2]});
  const double log = most > 0 ? std::floor(std::log2(most)) : -16.0;
  const double preliminary = std::max(-16.0, log) + 1.0 + 15.0;
  const double max_s = std::floor(most / std::exp2(preliminary - 24.0) + 0.5);
  const double shared = max_s == 512.0 ? preliminary + 1.0 : preliminary;
  std::uint32_t pixel = static_cast<std::uint32_t>(shared) << 27;
  for (std::size_t i = 0; i < 3; ++i)
    pixel |= static_cast<std::uint32_t>(std::floor(c[i] / std::exp2(shared - 24.0) + 0.5))
             << (9 * i);
  return pixel;
}

TEST(Rgb9e5, IsWhatItsDefinitionSays) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> exponent(-30.0f, 16.5f), share(0.0f, 1.0f);
  for (int i = 0; i < 500000; ++i) {
    const float most = std::exp2(exponent(random));
    const float r = most * share(random), g = most * share(random), b = most;
    ASSERT_EQ(rgb9e5_of(r, g, b), defined_rgb9e5({r, g, b})) << r << " " << g << " " << b;
  }
  for (int e = -24; e < 16; ++e)  // where the mantissa rounds up to 512
    for (const float part : {511.0f / 512.0f, 1023.0f / 1024.0f, 0.99999f, 1.0f}) {
      const float v = std::ldexp(part, e);
      ASSERT_EQ(rgb9e5_of(v, 0.0f, v), defined_rgb9e5({v, 0.0, v})) << v;
    }
}

TEST(Rgb9e5, ErrorIsAtMostA511thOfTheLargestChannel) {
  std::mt19937 random(4);
  std::uniform_real_distribution<float> exponent(-20.0f, 15.9f), share(0.0f, 1.0f);
  for (int i = 0; i < 500000; ++i) {
    const float most = std::exp2(exponent(random));
    const std::array<float, 3> rgb{most * share(random), most, most * share(random)};
    const std::uint32_t pixel = rgb9e5_of(rgb[0], rgb[1], rgb[2]);
    for (int c = 0; c < 3; ++c)
      ASSERT_LE(std::abs(static_cast<double>(from_rgb9e5(pixel, c)) -
                         static_cast<double>(rgb[static_cast<std::size_t>(c)])),
                std::max(static_cast<double>(most) / 511.0, 0x1p-25));
  }
}

TEST(Rgb9e5, EveryPixelThatItWritesRoundTrips) {
  std::mt19937 random(5);
  for (int i = 0; i < 500000; ++i) {
    const std::uint32_t any = static_cast<std::uint32_t>(random());
    const float r = from_rgb9e5(any, 0), g = from_rgb9e5(any, 1), b = from_rgb9e5(any, 2);
    const std::uint32_t pixel = rgb9e5_of(r, g, b);  // perhaps with a smaller exponent
    EXPECT_EQ(from_rgb9e5(pixel, 0), r);
    EXPECT_EQ(from_rgb9e5(pixel, 1), g);
    EXPECT_EQ(from_rgb9e5(pixel, 2), b);
  }
  EXPECT_EQ(rgb9e5_of(NAN, -1.0f, 0.0f), 0u);
  EXPECT_EQ(from_rgb9e5(rgb9e5_of(1e9f, 0.0f, INFINITY), 2), kLargestRgb9e5);
}

double angle_between(const Direction& a, double x, double y, double z) {
  const double ax = a.x, ay = a.y, az = a.z;
  const double cx = ay * z - az * y, cy = az * x - ax * z, cz = ax * y - ay * x;
  return std::atan2(std::sqrt(cx * cx + cy * cy + cz * cz), ax * x + ay * y + az * z);
}

TEST(Octahedral, LargestAngleIsBelow65MicroradiansAndLengthIsOne) {
  std::mt19937 random(6);
  std::normal_distribution<double> normal;
  double most = 0;
  for (int i = 0; i < 1000000; ++i) {
    const double x = normal(random), y = normal(random), z = normal(random);
    const Direction d = from_octahedral(
        octahedral_of(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)));
    most = std::max(most, angle_between(d, x, y, z));
    ASSERT_NEAR(std::hypot(d.x, d.y, d.z), 1.0f, 3e-7f);
  }
  RecordProperty("largest_angle_microradians", std::to_string(most * 1e6));
  EXPECT_LT(most, 65e-6);
  EXPECT_GT(most, 60e-6) << "as large as the step asks for: the test looks in the right places";
}

TEST(Octahedral, AxesAreExactAndLengthDoesNotMatter) {
  for (const float length : {1e-20f, 0.5f, 1.0f, 3.0f, 1e20f})
    for (const auto& axis :
         {std::array{1.f, 0.f, 0.f}, std::array{-1.f, 0.f, 0.f}, std::array{0.f, 1.f, 0.f},
          std::array{0.f, -1.f, 0.f}, std::array{0.f, 0.f, 1.f}, std::array{0.f, 0.f, -1.f}}) {
      const Direction d =
          from_octahedral(octahedral_of(axis[0] * length, axis[1] * length, axis[2] * length));
      EXPECT_EQ(d.x, axis[0]);
      EXPECT_EQ(d.y, axis[1]);
      EXPECT_EQ(d.z, axis[2]);
    }
}

TEST(Octahedral, NoDirectionStaysNoneAndWhatIsNotFiniteArrivesAsNan) {
  const Direction none = from_octahedral(octahedral_of(0.0f, -0.0f, 0.0f));
  EXPECT_EQ(none.x, 0.0f);
  EXPECT_EQ(none.y, 0.0f);
  EXPECT_EQ(none.z, 0.0f);
  for (const auto& bad : {std::array{NAN, 0.f, 1.f}, std::array{0.f, INFINITY, 0.f},
                          std::array{0.f, 1.f, -INFINITY}, std::array{NAN, NAN, NAN}}) {
    const Direction d = from_octahedral(octahedral_of(bad[0], bad[1], bad[2]));
    EXPECT_TRUE(std::isnan(d.x) && std::isnan(d.y) && std::isnan(d.z));
  }
}

TEST(Octahedral, EveryCodeIsAUnitVectorOrReserved) {
  std::mt19937 random(7);
  for (int i = 0; i < 1000000; ++i) {
    auto code = static_cast<std::uint32_t>(random());
    if (i % 16 == 0) code = (code & 0xffff0000u) | 0x8000u;
    const Direction d = from_octahedral(code);
    if (code == kNoDirection)
      ASSERT_EQ(d.x, 0.0f);
    else if ((code & 0xffffu) == 0x8000u)
      ASSERT_TRUE(std::isnan(d.x) && std::isnan(d.y) && std::isnan(d.z));
    else
      ASSERT_NEAR(std::hypot(d.x, d.y, d.z), 1.0f, 3e-7f) << code;
  }
}

TEST(Formats, AllInstructionSetsGiveTheSameBits) {
  const test::IsaGuard guard;
  constexpr std::size_t kCount = 4099;  // whole vectors and a rest
  std::mt19937 random(8);
  std::array<std::vector<std::uint32_t>, 3> words;
  for (auto& channel : words)
    for (std::size_t i = 0; i < kCount; ++i)
      channel.push_back(i % 4 ? std::bit_cast<std::uint32_t>(std::ldexp(
                                    static_cast<float>(random()), static_cast<int>(i % 50) - 60))
                              : static_cast<std::uint32_t>(random()));
  for (int number = 1; number <= 9; ++number) {
    const auto format = static_cast<PlaneFormat>(number);
    std::vector<std::byte> first;
    std::array<std::vector<std::uint32_t>, 3> first_words;
    for (const Isa isa : available_isas()) {
      select_isa(isa);
      std::vector<std::byte> bytes(kCount * element_bytes(format));
      encode_row(format, {{words[0].data(), words[1].data(), words[2].data()}, kCount},
                 bytes.data());
      std::array<std::vector<std::uint32_t>, 3> back;
      back.fill(std::vector<std::uint32_t>(kCount));
      decode_row(format, bytes.data(), {{back[0].data(), back[1].data(), back[2].data()}, kCount});
      if (first.empty()) first = bytes, first_words = back;
      EXPECT_TRUE(bytes == first) << format_name(format) << " " << isa_name(isa);
      EXPECT_TRUE(back == first_words) << format_name(format) << " " << isa_name(isa);
    }
  }
}

}  // namespace
}  // namespace holdfast::wire
