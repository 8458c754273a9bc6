#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "core/frame/plane_id.h"

/// How the values of a plane are written on the wire. docs/wire.md states each format's error.
namespace holdfast::wire {

/// The numbers are those of PlaneFormat in the protocol, where 0 stands for the full format.
enum class PlaneFormat : std::uint8_t {
  kF32 = 1,           ///< IEEE 754 single: the value as it is
  kF16 = 2,           ///< IEEE 754 half, rounded to nearest even; infinities and NaN are kept
  kUnorm8 = 3,        ///< round(255 v) of v in 0..1
  kUnorm16 = 4,       ///< round(65535 v) of v in 0..1
  kOctahedral16 = 5,  ///< a direction as two snorm16 of the octahedral map (Cigolle et al. 2014)
  kRgb9e5 = 6,  ///< three 9-bit mantissas and one 5-bit exponent (EXT_texture_shared_exponent)
  kU8 = 7,      ///< ids below 2^8
  kU16 = 8,     ///< ids below 2^16
  kU32 = 9,     ///< ids
};

/// "f32", "octahedral16" and so on.
std::string_view format_name(PlaneFormat format);

/// Bytes of one element: a value, or a pixel where the format joins the channels of a pixel.
std::size_t element_bytes(PlaneFormat format);

/// True if an element is a pixel with all of its channels; else channels follow one another.
bool joins_channels(PlaneFormat format);

/// f32, or u32 for ids: what keeps every bit.
PlaneFormat full_format(PlaneKind kind);

/// True if planes of that kind can be written in that format: ids as ids, directions and normals
/// also octahedral, what has three other channels also rgb9e5.
bool format_suits(PlaneFormat format, PlaneKind kind);

/// The format for values that do not fit `format`; the full ones are their own.
PlaneFormat wider_format(PlaneFormat format);

/// The format with that number in the protocol, if there is one that suits `kind`; 0 is the full
/// one.
std::optional<PlaneFormat> format_from_number(int number, PlaneKind kind);

/// Its number in the protocol: 0 for the full format.
int format_number(PlaneFormat format, PlaneKind kind);

}  // namespace holdfast::wire
