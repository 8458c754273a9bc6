#pragma once

#include <bit>
#include <cstdint>

#include "core/kernels/math.h"

/// One value or pixel to and from each format: branch-free, so that loops over them vectorise, and
/// without fused sums, so that every instruction set gives the same bits. Any code decodes to
/// something defined.
namespace holdfast::wire {

/// IEEE 754 half of `v`, rounded to nearest, ties to even; from 65520 on it is infinite. A NaN
/// becomes the quiet NaN 0x7e00.
HOLDFAST_INLINE std::uint16_t half_of(float v) noexcept {
  constexpr std::uint32_t kInfinite = 0x7f800000u, kSmallestNormal = 0x38800000u,
                          kTooLarge = 0x47800000u;  // 2^-14, 2^16
  const auto bits = std::bit_cast<std::uint32_t>(v);
  const std::uint32_t size = bits & 0x7fffffffu;
  // The exponent's bias goes from 127 to 15; 13 bits are rounded away.
  const std::uint32_t normal = (size + 0xc8000fffu + ((size >> 13) & 1u)) >> 13;
  // Adding 1/2 makes the adder round to multiples of 2^-24, the subnormal step.
  const std::uint32_t subnormal =
      std::bit_cast<std::uint32_t>(std::bit_cast<float>(size) + 0.5f) - 0x3f000000u;
  const std::uint32_t special = size > kInfinite ? 0x7e00u : 0x7c00u;
  const std::uint32_t finite = size < kSmallestNormal ? subnormal : normal;
  return static_cast<std::uint16_t>((size < kTooLarge ? finite : special) |
                                    ((bits >> 16) & 0x8000u));
}

/// The value of a half, exactly.
HOLDFAST_INLINE float from_half(std::uint16_t half) noexcept {
  const std::uint32_t size = half & 0x7fffu;
  const float scaled = std::bit_cast<float>(size << 13) * 0x1p112f;  // subnormals come out right
  const std::uint32_t special = size >= 0x7c00u ? 0x7f800000u : 0u;
  return std::bit_cast<float>(std::bit_cast<std::uint32_t>(scaled) | special |
                              (static_cast<std::uint32_t>(half & 0x8000u) << 16));
}

/// round(most v) of v clamped to 0..1; 0 for NaN.
HOLDFAST_INLINE std::uint32_t unorm_of(float v, float most) noexcept {
  const float positive = v > 0.0f ? v : 0.0f;
  const float bounded = positive < 1.0f ? positive : 1.0f;
  return static_cast<std::uint32_t>(static_cast<std::int32_t>(bounded * most + 0.5f));
}

/// code / most, correctly rounded: both ends are exact.
HOLDFAST_INLINE float from_unorm(std::uint32_t code, float most) noexcept {
  return static_cast<float>(static_cast<std::int32_t>(code)) / most;
}

/// The largest value of rgb9e5: 511/512 2^16.
inline constexpr float kLargestRgb9e5 = 65408.0f;

/// `v` within 0..kLargestRgb9e5; 0 for NaN.
HOLDFAST_INLINE float within_rgb9e5(float v) noexcept {
  const float positive = v > 0.0f ? v : 0.0f;
  return positive < kLargestRgb9e5 ? positive : kLargestRgb9e5;
}

/// round(v) of v >= 0.
HOLDFAST_INLINE std::uint32_t rounded(float v) noexcept {
  return static_cast<std::uint32_t>(static_cast<std::int32_t>(v + 0.5f));
}

/// The pixel's mantissas of 9 bits, red lowest, below the exponent of 5 bits with bias 15: value =
/// mantissa 2^(exponent - 24). Rounded to nearest: the error is at most 1/511 of the largest
/// channel, or 2^-25. Negative values and NaN become 0, too large ones kLargestRgb9e5.
HOLDFAST_INLINE std::uint32_t rgb9e5_of(float r, float g, float b) noexcept {
  const float red = within_rgb9e5(r), green = within_rgb9e5(g), blue = within_rgb9e5(b);
  const float most = max_of(max_of(red, green), blue);
  // Half a step is added before the exponent is taken: a mantissa that rounds up to 512 moves it.
  const auto exponent =
      static_cast<std::int32_t>((std::bit_cast<std::uint32_t>(most) + 0x4000u) >> 23) - 127;
  const std::int32_t shared = exponent > -16 ? exponent + 16 : 0;
  const float scale = std::bit_cast<float>((127 + 24 - shared) << 23);
  return rounded(red * scale) | rounded(green * scale) << 9 | rounded(blue * scale) << 18 |
         static_cast<std::uint32_t>(shared) << 27;
}

/// One channel of a pixel, exactly.
HOLDFAST_INLINE float from_rgb9e5(std::uint32_t pixel, int channel) noexcept {
  const auto mantissa = static_cast<std::int32_t>((pixel >> (9 * channel)) & 0x1ffu);
  return static_cast<float>(mantissa) * std::bit_cast<float>((127 - 24 + (pixel >> 27)) << 23);
}

/// Codes that are no direction: x is the snorm16 that no direction uses.
inline constexpr std::uint32_t kNoDirection = 0x00008000u;   ///< (0,0,0)
inline constexpr std::uint32_t kBadDirection = 0x80008000u;  ///< not finite

/// The direction of (x,y,z), of any length, on the octahedron unfolded to a square: x in the low
/// and y in the high half, each round(32767 t) of t in -1..1.
HOLDFAST_INLINE std::uint32_t octahedral_of(float x, float y, float z) noexcept {
  const float sum = abs_of(x) + abs_of(y) + abs_of(z);
  const bool direction = sum > 0.0f && sum < 0x1p127f;
  const float safe = direction ? sum : 1.0f;
  const float u = x / safe, v = y / safe;
  const float outer_u = u < 0.0f ? abs_of(v) - 1.0f : 1.0f - abs_of(v);
  const float outer_v = v < 0.0f ? abs_of(u) - 1.0f : 1.0f - abs_of(u);
  const float s = 32767.0f * (z < 0.0f ? outer_u : u), t = 32767.0f * (z < 0.0f ? outer_v : v);
  const float s_bounded = direction ? s : 0.0f, t_bounded = direction ? t : 0.0f;
  const auto a = static_cast<std::int32_t>(s_bounded + (s_bounded < 0.0f ? -0.5f : 0.5f));
  const auto b = static_cast<std::int32_t>(t_bounded + (t_bounded < 0.0f ? -0.5f : 0.5f));
  const std::uint32_t code =
      (static_cast<std::uint32_t>(a) & 0xffffu) | static_cast<std::uint32_t>(b) << 16;
  const std::uint32_t none = sum == 0.0f ? kNoDirection : kBadDirection;
  return direction ? code : none;
}

struct Direction {
  float x, y, z;
};

/// The unit vector of a code; (0,0,0) for kNoDirection, NaN for the other codes with its x.
HOLDFAST_INLINE Direction from_octahedral(std::uint32_t code) noexcept {
  const auto a = static_cast<std::int32_t>(static_cast<std::int16_t>(code & 0xffffu));
  const auto b = static_cast<std::int32_t>(static_cast<std::int16_t>(code >> 16));
  const float u = static_cast<float>(a) * (1.0f / 32767.0f);
  const float v = static_cast<float>(b) * (1.0f / 32767.0f);
  const float z = 1.0f - abs_of(u) - abs_of(v);
  const float fold = z < 0.0f ? -z : 0.0f;
  const float x = u < 0.0f ? u + fold : u - fold;
  const float y = v < 0.0f ? v + fold : v - fold;
  const float length = __builtin_sqrtf(x * x + y * y + z * z);
  const float bad = std::bit_cast<float>(0x7fc00000u);
  const float reserved = code == kNoDirection ? 0.0f : bad;
  const bool direction = a != -32768;
  return {direction ? x / length : reserved, direction ? y / length : reserved,
          direction ? z / length : reserved};
}

}  // namespace holdfast::wire
