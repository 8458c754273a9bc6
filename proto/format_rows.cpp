#include "proto/format_rows.h"

#include <cstring>

#include "core/kernels/variants.h"
#include "proto/number_formats.h"

namespace holdfast::wire {
namespace {

/// Encodes from `in`, decodes to `out`; the other side is `bytes`.
struct Encode {
  const std::uint32_t* in[3];
  std::size_t count;
  std::byte* bytes;
};
struct Decode {
  const std::byte* bytes;
  std::size_t count;
  std::uint32_t* out[3];
};
struct FloatRange {
  const std::uint32_t* in;
  std::size_t count;
  ValueRange* range;
};

template <class T>
HOLDFAST_INLINE void put(std::byte* bytes, std::size_t i, T value) {
  __builtin_memcpy(bytes + i * sizeof(T), &value, sizeof(T));
}
template <class T>
HOLDFAST_INLINE T get(const std::byte* bytes, std::size_t i) {
  T value;
  __builtin_memcpy(&value, bytes + i * sizeof(T), sizeof(T));
  return value;
}
HOLDFAST_INLINE float float_of(std::uint32_t word) { return std::bit_cast<float>(word); }
HOLDFAST_INLINE std::uint32_t word_of(float value) { return std::bit_cast<std::uint32_t>(value); }

// --- values --------------------------------------------------------------------------------------

HOLDFAST_INLINE void to_f16_body(const Encode& a) {
  const std::size_t count = a.count;  // a byte that is written might be part of it
  const std::uint32_t* __restrict in = a.in[0];
  std::byte* __restrict bytes = a.bytes;
  for (std::size_t i = 0; i < count; ++i) put(bytes, i, half_of(float_of(in[i])));
}
HOLDFAST_INLINE void from_f16_body(const Decode& a) {
  const std::size_t count = a.count;  // a byte that is written might be part of it
  const std::byte* __restrict bytes = a.bytes;
  std::uint32_t* __restrict out = a.out[0];
  for (std::size_t i = 0; i < count; ++i) out[i] = word_of(from_half(get<std::uint16_t>(bytes, i)));
}
HOLDFAST_INLINE void to_unorm8_body(const Encode& a) {
  const std::size_t count = a.count;  // a byte that is written might be part of it
  const std::uint32_t* __restrict in = a.in[0];
  std::byte* __restrict bytes = a.bytes;
  for (std::size_t i = 0; i < count; ++i)
    put(bytes, i, static_cast<std::uint8_t>(unorm_of(float_of(in[i]), 255.0f)));
}
HOLDFAST_INLINE void from_unorm8_body(const Decode& a) {
  const std::size_t count = a.count;  // a byte that is written might be part of it
  const std::byte* __restrict bytes = a.bytes;
  std::uint32_t* __restrict out = a.out[0];
  for (std::size_t i = 0; i < count; ++i)
    out[i] = word_of(from_unorm(get<std::uint8_t>(bytes, i), 255.0f));
}
HOLDFAST_INLINE void to_unorm16_body(const Encode& a) {
  const std::size_t count = a.count;  // a byte that is written might be part of it
  const std::uint32_t* __restrict in = a.in[0];
  std::byte* __restrict bytes = a.bytes;
  for (std::size_t i = 0; i < count; ++i)
    put(bytes, i, static_cast<std::uint16_t>(unorm_of(float_of(in[i]), 65535.0f)));
}
HOLDFAST_INLINE void from_unorm16_body(const Decode& a) {
  const std::size_t count = a.count;  // a byte that is written might be part of it
  const std::byte* __restrict bytes = a.bytes;
  std::uint32_t* __restrict out = a.out[0];
  for (std::size_t i = 0; i < count; ++i)
    out[i] = word_of(from_unorm(get<std::uint16_t>(bytes, i), 65535.0f));
}

// --- pixels --------------------------------------------------------------------------------------

HOLDFAST_INLINE void to_octahedral_body(const Encode& a) {
  const std::size_t count = a.count;  // a byte that is written might be part of it
  const std::uint32_t* __restrict x = a.in[0];
  const std::uint32_t* __restrict y = a.in[1];
  const std::uint32_t* __restrict z = a.in[2];
  std::byte* __restrict bytes = a.bytes;
  for (std::size_t i = 0; i < count; ++i)
    put(bytes, i, octahedral_of(float_of(x[i]), float_of(y[i]), float_of(z[i])));
}
HOLDFAST_INLINE void from_octahedral_body(const Decode& a) {
  const std::size_t count = a.count;  // a byte that is written might be part of it
  const std::byte* __restrict bytes = a.bytes;
  std::uint32_t* __restrict x = a.out[0];
  std::uint32_t* __restrict y = a.out[1];
  std::uint32_t* __restrict z = a.out[2];
  for (std::size_t i = 0; i < count; ++i) {
    const Direction d = from_octahedral(get<std::uint32_t>(bytes, i));
    x[i] = word_of(d.x);
    y[i] = word_of(d.y);
    z[i] = word_of(d.z);
  }
}
HOLDFAST_INLINE void to_rgb9e5_body(const Encode& a) {
  const std::size_t count = a.count;  // a byte that is written might be part of it
  const std::uint32_t* __restrict r = a.in[0];
  const std::uint32_t* __restrict g = a.in[1];
  const std::uint32_t* __restrict b = a.in[2];
  std::byte* __restrict bytes = a.bytes;
  for (std::size_t i = 0; i < count; ++i)
    put(bytes, i, rgb9e5_of(float_of(r[i]), float_of(g[i]), float_of(b[i])));
}
HOLDFAST_INLINE void from_rgb9e5_body(const Decode& a) {
  const std::size_t count = a.count;  // a byte that is written might be part of it
  const std::byte* __restrict bytes = a.bytes;
  std::uint32_t* __restrict r = a.out[0];
  std::uint32_t* __restrict g = a.out[1];
  std::uint32_t* __restrict b = a.out[2];
  for (std::size_t i = 0; i < count; ++i) {
    const auto pixel = get<std::uint32_t>(bytes, i);
    r[i] = word_of(from_rgb9e5(pixel, 0));
    g[i] = word_of(from_rgb9e5(pixel, 1));
    b[i] = word_of(from_rgb9e5(pixel, 2));
  }
}

// --- ids -----------------------------------------------------------------------------------------

HOLDFAST_INLINE void to_u8_body(const Encode& a) {
  const std::size_t count = a.count;  // a byte that is written might be part of it
  const std::uint32_t* __restrict in = a.in[0];
  std::byte* __restrict bytes = a.bytes;
  for (std::size_t i = 0; i < count; ++i) put(bytes, i, static_cast<std::uint8_t>(in[i]));
}
HOLDFAST_INLINE void from_u8_body(const Decode& a) {
  const std::size_t count = a.count;  // a byte that is written might be part of it
  const std::byte* __restrict bytes = a.bytes;
  std::uint32_t* __restrict out = a.out[0];
  for (std::size_t i = 0; i < count; ++i) out[i] = get<std::uint8_t>(bytes, i);
}
HOLDFAST_INLINE void to_u16_body(const Encode& a) {
  const std::size_t count = a.count;  // a byte that is written might be part of it
  const std::uint32_t* __restrict in = a.in[0];
  std::byte* __restrict bytes = a.bytes;
  for (std::size_t i = 0; i < count; ++i) put(bytes, i, static_cast<std::uint16_t>(in[i]));
}
HOLDFAST_INLINE void from_u16_body(const Decode& a) {
  const std::size_t count = a.count;  // a byte that is written might be part of it
  const std::byte* __restrict bytes = a.bytes;
  std::uint32_t* __restrict out = a.out[0];
  for (std::size_t i = 0; i < count; ++i) out[i] = get<std::uint16_t>(bytes, i);
}

// --- ranges --------------------------------------------------------------------------------------

/// Flags are sign bits, which loops collect without a choice.
HOLDFAST_INLINE void float_range_body(const FloatRange& a) {
  constexpr std::int32_t kInfinite = 0x7f800000;
  const std::size_t count = a.count;
  const std::uint32_t* __restrict in = a.in;
  std::int32_t most = 0, negative = 0, infinite = 0, nan = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const auto word = static_cast<std::int32_t>(in[i]);
    const std::int32_t size = word & 0x7fffffff;
    const std::int32_t finite = size < kInfinite ? size : 0;
    most = most > finite ? most : finite;
    nan |= kInfinite - size;
    infinite |= (size ^ kInfinite) - 1;
    negative |= word & ~(size - 1);  // not of -0
  }
  ValueRange& range = *a.range;
  range.most = max_of(range.most, static_cast<std::uint32_t>(most));
  range.negative |= negative < 0 ? 1 : 0;
  range.infinite |= infinite < 0 ? 1 : 0;
  range.nan |= nan < 0 ? 1 : 0;
}

HOLDFAST_KERNEL(to_f16, Encode)
HOLDFAST_KERNEL(from_f16, Decode)
HOLDFAST_KERNEL(to_unorm8, Encode)
HOLDFAST_KERNEL(from_unorm8, Decode)
HOLDFAST_KERNEL(to_unorm16, Encode)
HOLDFAST_KERNEL(from_unorm16, Decode)
HOLDFAST_KERNEL(to_octahedral, Encode)
HOLDFAST_KERNEL(from_octahedral, Decode)
HOLDFAST_KERNEL(to_rgb9e5, Encode)
HOLDFAST_KERNEL(from_rgb9e5, Decode)
HOLDFAST_KERNEL(to_u8, Encode)
HOLDFAST_KERNEL(from_u8, Decode)
HOLDFAST_KERNEL(to_u16, Encode)
HOLDFAST_KERNEL(from_u16, Decode)
HOLDFAST_KERNEL(float_range, FloatRange)

}  // namespace

void encode_row(PlaneFormat format, const FormatRow<const std::uint32_t>& row, std::byte* out) {
  const Encode args{{row.words[0], row.words[1], row.words[2]}, row.count, out};
  switch (format) {
    case PlaneFormat::kF32:
    case PlaneFormat::kU32: std::memcpy(out, row.words[0], row.count * 4); return;
    case PlaneFormat::kF16: return to_f16(args);
    case PlaneFormat::kUnorm8: return to_unorm8(args);
    case PlaneFormat::kUnorm16: return to_unorm16(args);
    case PlaneFormat::kOctahedral16: return to_octahedral(args);
    case PlaneFormat::kRgb9e5: return to_rgb9e5(args);
    case PlaneFormat::kU8: return to_u8(args);
    case PlaneFormat::kU16: return to_u16(args);
  }
}

void decode_row(PlaneFormat format, const std::byte* in, const FormatRow<std::uint32_t>& row) {
  const Decode args{in, row.count, {row.words[0], row.words[1], row.words[2]}};
  switch (format) {
    case PlaneFormat::kF32:
    case PlaneFormat::kU32: std::memcpy(row.words[0], in, row.count * 4); return;
    case PlaneFormat::kF16: return from_f16(args);
    case PlaneFormat::kUnorm8: return from_unorm8(args);
    case PlaneFormat::kUnorm16: return from_unorm16(args);
    case PlaneFormat::kOctahedral16: return from_octahedral(args);
    case PlaneFormat::kRgb9e5: return from_rgb9e5(args);
    case PlaneFormat::kU8: return from_u8(args);
    case PlaneFormat::kU16: return from_u16(args);
  }
}

void add_float_range(const std::uint32_t* values, std::size_t count, ValueRange& range) {
  float_range({values, count, &range});
}

void add_id_range(const std::uint32_t* values, std::size_t count, ValueRange& range) {
  std::uint32_t most = range.most;
  for (std::size_t i = 0; i < count; ++i) most = max_of(most, values[i]);
  range.most = most;
}

}  // namespace holdfast::wire
