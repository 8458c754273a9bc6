#pragma once

#include <cstddef>
#include <cstdint>

#include "proto/plane_format.h"

/// Rows of values to and from the bytes of a format, by the selected instruction set.
namespace holdfast::wire {

/// A run of values of one channel, or of pixels of all channels, as words of 4 bytes (float or id).
template <class Word>
struct FormatRow {
  Word* words[3];  ///< of each channel; the first alone unless the format joins channels
  std::size_t count;
};

/// Writes `row` to `out`, element_bytes(format) * row.count bytes without alignment.
void encode_row(PlaneFormat format, const FormatRow<const std::uint32_t>& row, std::byte* out);
/// The inverse. Any bytes give defined values; see proto/number_formats.h.
void decode_row(PlaneFormat format, const std::byte* in, const FormatRow<std::uint32_t>& row);

/// What values of a plane there are, as far as it matters to a format.
struct ValueRange {
  std::uint32_t most = 0;  ///< ids: the largest; floats: bits of the largest finite magnitude
  /// Some value is below 0, infinite, not a number.
  std::uint32_t negative = 0, infinite = 0, nan = 0;
};
/// Adds `count` values, as words of 4 bytes.
void add_float_range(const std::uint32_t* values, std::size_t count, ValueRange& range);
void add_id_range(const std::uint32_t* values, std::size_t count, ValueRange& range);

}  // namespace holdfast::wire
