#include "core/history/half_block.h"

#include <cstring>

#include "core/history/block_exponent.h"
#include "core/kernels/variants.h"

namespace holdfast {
namespace {

constexpr std::uint32_t kLost = 0x1fffu;  // bits of a float that a half has no room for
constexpr int kGreatest = 14;             // exponent of the greatest value of a block
constexpr std::int32_t kLeastNormal = (kFloatBias - 14) << 23;  // the bits of 2^-14

/// The finaliser of MurmurHash3 (Appleby).
HOLDFAST_INLINE void draw_body(const BlockBits& a) {
  const std::uint32_t seed = a.seed;
  std::uint32_t* out = a.out;
  for (std::uint32_t i = 0; i < kHalfBlock; ++i) {
    std::uint32_t h = (i * 0x9e3779b9u) ^ seed;
    h = (h ^ (h >> 16)) * 0x85ebca6bu;
    h = (h ^ (h >> 13)) * 0xc2b2ae35u;
    out[i] = h ^ (h >> 16);
  }
}

/// A block's values, scaled and rounded to what halves hold; tiny ones only moved by their share of
/// a step, so that narrowing to the nearest rounds them at random, too.
struct Rounding {
  const HalfPacking& block;
  float* out;  ///< kHalfBlock
};

HOLDFAST_INLINE void round_block_body(const Rounding& a) {
  const float* in = a.block.in;
  const int count = a.block.count;
  const std::uint32_t* random = a.block.random;
  const int shift = block_shift(in, count, kGreatest);
  *a.block.exponent = static_cast<std::int8_t>(shift);
  const float scale = power_of_two(shift);
  float* out = a.out;
  for (int i = count; i < kHalfBlock; ++i) out[i] = 0.0f;
#pragma GCC ivdep
  for (int i = 0; i < count; ++i) {
    const std::uint32_t noise = random[i] & kLost;
    const std::uint32_t bits = std::bit_cast<std::uint32_t>(in[i] * scale),
                        magnitude = bits & kMagnitudeBits;
    // Above -1/2 and below 1/2 of the least half's step: a multiple of it stays what it is.
    const float part = static_cast<float>(static_cast<std::int32_t>(2 * noise + 1)) * 0x1p-38f;
    const float moved = max_of(std::bit_cast<float>(magnitude) + (part - 0x1p-25f), 0.0f);
    const std::uint32_t tiny = std::bit_cast<std::uint32_t>(moved) | (bits & ~kMagnitudeBits);
    const std::uint32_t normal = (bits + noise) & ~kLost;
    out[i] =
        std::bit_cast<float>(static_cast<std::int32_t>(magnitude) < kLeastNormal ? tiny : normal);
  }
}

struct Narrowing {
  const float* in;  ///< as `round_block` leaves them
  int count;
  std::uint16_t* out;
};

HOLDFAST_INLINE int whole_groups(int count) {
  return (count + kHalfGroup - 1) / kHalfGroup * kHalfGroup;
}

HOLDFAST_INLINE void narrow_plain_body(const Narrowing& a) {
  constexpr std::uint32_t kRebias = std::uint32_t{kFloatBias - 15} << 10;
  const float* in = a.in;
  std::uint16_t* out = a.out;
  const int count = whole_groups(a.count);
#pragma GCC ivdep
  for (int i = 0; i < count; ++i) {
    const std::uint32_t bits = std::bit_cast<std::uint32_t>(in[i]),
                        magnitude = bits & kMagnitudeBits;
    // A step of a float at 0.5 is one of the least halves: the sum's rounding is theirs.
    const float moved = std::bit_cast<float>(magnitude) + 0.5f;
    const std::uint32_t tiny = std::bit_cast<std::uint32_t>(moved) - 0x3f000000u;
    const std::uint32_t normal = (magnitude >> 13) - kRebias;
    const std::uint32_t half = static_cast<std::int32_t>(magnitude) < kLeastNormal ? tiny : normal;
    out[i] = static_cast<std::uint16_t>(half | ((bits >> 16) & 0x8000u));
  }
}

HOLDFAST_INLINE void widen_plain_body(const HalfUnpacking& a) {
  const float scale = power_of_two(-a.exponent);
  const std::uint16_t* in = a.in;
  float* out = a.out;
  const int count = whole_groups(a.count);
#pragma GCC ivdep
  for (int i = 0; i < count; ++i) {
    const std::uint32_t half = in[i];
    const float magnitude =
        std::bit_cast<float>((half & 0x7fffu) << 13) * power_of_two(kFloatBias - 15);
    const std::uint32_t sign = (half & 0x8000u) << 16;
    out[i] = std::bit_cast<float>(std::bit_cast<std::uint32_t>(magnitude * scale) | sign);
  }
}

HOLDFAST_KERNEL(draw, BlockBits)
HOLDFAST_KERNEL(round_block, Rounding)
HOLDFAST_KERNEL(narrow_plain, Narrowing)
HOLDFAST_KERNEL(widen_plain, HalfUnpacking)

#if defined(__x86_64__)
// By the conversions of the machine, eight at a time, which every x86-64-v3 has.

using Halves = short __attribute__((vector_size(16)));
using Floats = float __attribute__((vector_size(32)));

__attribute__((target("arch=x86-64-v3"))) void narrow_by_f16c(const Narrowing& a) noexcept {
  for (int i = 0; i < a.count; i += 8) {
    Floats values;
    std::memcpy(&values, a.in + i, sizeof values);
    const Halves halves = __builtin_ia32_vcvtps2ph256(values, 0);  // 0: to the nearest
    std::memcpy(a.out + i, &halves, sizeof halves);
  }
}

__attribute__((target("arch=x86-64-v3"))) void widen_by_f16c(const HalfUnpacking& a) noexcept {
  const float scale = power_of_two(-a.exponent);
  for (int i = 0; i < a.count; i += 8) {
    Halves halves;
    std::memcpy(&halves, a.in + i, sizeof halves);
    const Floats values = __builtin_ia32_vcvtph2ps256(halves) * scale;
    std::memcpy(a.out + i, &values, sizeof values);
  }
}

bool has_f16c() { return selected_isa() == Isa::kX86_64V3 || selected_isa() == Isa::kX86_64V4; }
#endif

void narrow(const Narrowing& a) noexcept {
#if defined(__x86_64__)
  if (has_f16c()) return narrow_by_f16c(a);
#endif
  narrow_plain(a);
}

}  // namespace

void draw_block_bits(const BlockBits& block) noexcept { draw(block); }

void pack_half_block(const HalfPacking& block) noexcept {
  float rounded[kHalfBlock];
  round_block({block, rounded});
  narrow({rounded, block.count, block.out});
}

void unpack_half_block(const HalfUnpacking& block) noexcept {
#if defined(__x86_64__)
  if (has_f16c()) return widen_by_f16c(block);
#endif
  widen_plain(block);
}

}  // namespace holdfast
