#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <type_traits>

/// Inlined into every instruction-set variant of a kernel.
#define HOLDFAST_INLINE inline __attribute__((always_inline))

namespace holdfast {

/// exp(x) for x <= 0. In float: 2^i * p(f) with a polynomial of degree 5 for 2^f on [-1/2, 1/2],
/// error below 6e-6 of the value plus 1.2e-38, exactly 0 below about -87. In double: std::exp.
/// Branch-free, so that loops that call it vectorise. NaN gives an unspecified finite value.
template <class T>
HOLDFAST_INLINE T exp_nonpositive(T x) noexcept {
  if constexpr (std::is_same_v<T, float>) {
    constexpr float kLog2E = 1.44269504f;
    constexpr float kSmallest = 1.17549435e-38f;  // 2^-126
    constexpr float kRound = 12582912.0f;         // 1.5 2^23: adding it rounds to an integer
    const float t = x * kLog2E > -126.0f ? x * kLog2E : -126.0f;
    const float rounded = t + kRound;  // i sits in its low bits
    const float f = t - (rounded - kRound);
    float p = 1.3333558e-3f;  // Taylor coefficients ln(2)^k / k!
    p = p * f + 9.6181291e-3f;
    p = p * f + 5.5504109e-2f;
    p = p * f + 2.4022651e-1f;
    p = p * f + 6.9314718e-1f;
    p = p * f + 1.0f;
    const std::uint32_t exponent = std::bit_cast<std::uint32_t>(rounded) << 23;
    const float scaled = std::bit_cast<float>(std::bit_cast<std::uint32_t>(p) + exponent);
    return scaled - kSmallest;  // exactly 0 where t was clamped
  } else {
    return std::exp(x);
  }
}

/// max(x, 0); 0 for NaN of either kind is not promised. The bits of a float order as an integer's
/// do about 0, and the maximum of integers is one instruction everywhere.
HOLDFAST_INLINE float positive_part(float x) noexcept {
  const auto bits = std::bit_cast<std::int32_t>(x);
  return std::bit_cast<float>(bits > 0 ? bits : 0);
}

/// What `weight_exp` takes for h > 0: 2^23 (127 + log2 h), the bits of h read as a number.
HOLDFAST_INLINE float weight_bits(float log2_h) noexcept { return 0x1p23f * (127.0f + log2_h); }

/// h exp(-s) for s >= 0 and h <= 1, given weight_bits(log2 h): error below 7.5e-6 of it for
/// values above 1.2e-38, exactly 0 below. The bits of a power of two are found by one product, and
/// what they hold as its mantissa, m in [1, 2), is corrected from 1 + (m - 1) to 2^(m - 1) by a
/// polynomial of degree 4 (minimax, relative error 2.6e-6). Half as dear as exp_nonpositive and a
/// product.
HOLDFAST_INLINE float weight_exp(float bits_of_h, float s) noexcept {
  constexpr float kBitsPerUnit = 0x1p23f * 1.44269504f;
  const float found = positive_part(bits_of_h - kBitsPerUnit * s);
  const auto bits = static_cast<std::int32_t>(found);
  const float m = std::bit_cast<float>((bits & 0x7fffff) | 0x3f800000);
  const float power = std::bit_cast<float>(bits & 0x7f800000);  // of two; 0 below all
  float p = 0.013534168f;
  p = p * m - 0.00212521f;
  p = p * m + 0.16661337f;
  p = p * m + 0.31201604f;
  p = p * m + 0.5099642f;
  return p * power;
}

/// log(x) of a normal x > 0. In float: error below 3e-7 of 1 + |log x|, branch-free; in double:
/// std::log. log m = 2 atanh((m - 1) / (m + 1)) for the mantissa m in [0.707, 1.414].
template <class T>
HOLDFAST_INLINE T log_of(T x) noexcept {
  if constexpr (std::is_same_v<T, float>) {
    constexpr float kLn2 = 0.693147181f;
    constexpr std::uint32_t kSqrtHalf = 0x3f3504f3u;
    const std::uint32_t bits = std::bit_cast<std::uint32_t>(x) - kSqrtHalf;
    const auto exponent = static_cast<float>(static_cast<std::int32_t>(bits) >> 23);
    const float m = std::bit_cast<float>((bits & 0x7fffffu) + kSqrtHalf);
    const float s = (m - 1.0f) / (m + 1.0f), s2 = s * s;
    const float series =
        1.0f + s2 * (1.0f / 3.0f + s2 * (1.0f / 5.0f + s2 * (1.0f / 7.0f + s2 * (1.0f / 9.0f))));
    return exponent * kLn2 + 2.0f * s * series;
  } else {
    return std::log(x);
  }
}

/// sin(2 pi v) for |v| <= 1/4, error below 3e-7: Taylor's series to the eleventh power.
HOLDFAST_INLINE float sine_of_quarter(float v) noexcept {
  const float t = 6.28318531f * v, t2 = t * t;
  return t * (1.0f + t2 * (-1.0f / 6.0f +
                           t2 * (1.0f / 120.0f +
                                 t2 * (-1.0f / 5040.0f +
                                       t2 * (1.0f / 362880.0f - t2 * (1.0f / 39916800.0f))))));
}

/// Rec. 709 luminance of a linear colour.
template <class T>
HOLDFAST_INLINE T luminance(T r, T g, T b) noexcept {
  return T(0.2126) * r + T(0.7152) * g + T(0.0722) * b;
}

template <class T>
HOLDFAST_INLINE T max_of(T a, T b) noexcept {
  return a > b ? a : b;
}

template <class T>
HOLDFAST_INLINE T min_of(T a, T b) noexcept {
  return a < b ? a : b;
}

template <class T>
HOLDFAST_INLINE T abs_of(T a) noexcept {
  if constexpr (std::is_same_v<T, float>)
    return __builtin_fabsf(a);  // one instruction, where a choice by sign is three
  else if constexpr (std::is_same_v<T, double>)
    return __builtin_fabs(a);
  else
    return a < T(0) ? -a : a;
}

template <class T>
HOLDFAST_INLINE T square(T a) noexcept {
  return a * a;
}

}  // namespace holdfast
