#include "core/history/byte_block.h"

#include "core/history/block_exponent.h"
#include "core/kernels/variants.h"

namespace holdfast {
namespace {

/// Bits of a float's mantissa that a byte has room for.
HOLDFAST_INLINE int mantissa_of(ByteKind kind) { return kind == ByteKind::kFine ? 5 : 3; }

/// The magnitude bits of a float, less this, are those of its byte: the greatest block value, just
/// below 2 and rounded up to it, has the greatest byte.
HOLDFAST_INLINE std::int32_t base_of(ByteKind kind) {
  return ((kFloatBias + 1) << mantissa_of(kind)) - 255;
}

HOLDFAST_INLINE void pack_byte_body(const BytePacking& a) {
  const float* in = a.in;
  std::uint8_t* out = a.out;
  const int count = a.count;
  const int shift = block_shift(in, count, 0);
  *a.exponent = static_cast<std::int8_t>(shift);
  const float scale = power_of_two(shift);
  const std::int32_t base = base_of(a.kind);
  const int lost = 23 - mantissa_of(a.kind);  // bits of the float's mantissa
  const std::uint32_t noise_mask = (1u << lost) - 1;
  const std::uint32_t* random = a.random;
#pragma GCC ivdep
  for (int i = 0; i < count; ++i) {
    const std::uint32_t noise = random[i] & noise_mask;
    const std::uint32_t bits = std::bit_cast<std::uint32_t>(in[i] * scale);
    const std::uint32_t rounded = ((bits & kMagnitudeBits) + noise) >> lost;
    out[i] = static_cast<std::uint8_t>(max_of(static_cast<std::int32_t>(rounded) - base, 0));
  }
}

HOLDFAST_INLINE void unpack_byte_body(const ByteUnpacking& a) {
  const std::uint8_t* in = a.in;
  float* out = a.out;
  const float scale = power_of_two(-a.exponent);
  const auto base = static_cast<std::uint32_t>(base_of(a.kind));
  const int lost = 23 - mantissa_of(a.kind);
#pragma GCC ivdep
  for (int i = 0; i < a.count; ++i) {
    const std::uint32_t code = in[i];
    out[i] = std::bit_cast<float>(code == 0 ? 0u : (code + base) << lost) * scale;
  }
}

HOLDFAST_KERNEL(pack_byte, BytePacking)
HOLDFAST_KERNEL(unpack_byte, ByteUnpacking)

}  // namespace

void pack_byte_block(const BytePacking& block) noexcept { pack_byte(block); }
void unpack_byte_block(const ByteUnpacking& block) noexcept { unpack_byte(block); }

}  // namespace holdfast
