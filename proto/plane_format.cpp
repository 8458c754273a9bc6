#include "proto/plane_format.h"

#include <array>

namespace holdfast::wire {
namespace {

enum class Holds { kFloats, kDirections, kColours, kIds };

struct Traits {
  std::string_view name;
  std::size_t bytes;
  Holds holds;
  PlaneFormat wider;
};

constexpr std::array<Traits, 9> kTraits{{
    {"f32", 4, Holds::kFloats, PlaneFormat::kF32},
    {"f16", 2, Holds::kFloats, PlaneFormat::kF32},
    {"unorm8", 1, Holds::kFloats, PlaneFormat::kF16},
    {"unorm16", 2, Holds::kFloats, PlaneFormat::kF32},
    {"octahedral16", 4, Holds::kDirections, PlaneFormat::kF32},
    {"rgb9e5", 4, Holds::kColours, PlaneFormat::kF16},
    {"u8", 1, Holds::kIds, PlaneFormat::kU16},
    {"u16", 2, Holds::kIds, PlaneFormat::kU32},
    {"u32", 4, Holds::kIds, PlaneFormat::kU32},
}};

const Traits& traits(PlaneFormat format) { return kTraits[static_cast<std::size_t>(format) - 1]; }

bool is_direction(PlaneKind kind) {
  return kind == PlaneKind::kNormal || kind == PlaneKind::kGlossyDirection ||
         kind == PlaneKind::kIndirectDirection;
}

}  // namespace

std::string_view format_name(PlaneFormat format) { return traits(format).name; }

std::size_t element_bytes(PlaneFormat format) { return traits(format).bytes; }

bool joins_channels(PlaneFormat format) {
  return format == PlaneFormat::kOctahedral16 || format == PlaneFormat::kRgb9e5;
}

PlaneFormat full_format(PlaneKind kind) {
  return plane_traits(kind).scalar == ScalarType::kUint ? PlaneFormat::kU32 : PlaneFormat::kF32;
}

bool format_suits(PlaneFormat format, PlaneKind kind) {
  const bool ids = plane_traits(kind).scalar == ScalarType::kUint;
  switch (traits(format).holds) {
    case Holds::kFloats: return !ids;
    case Holds::kDirections: return is_direction(kind);
    case Holds::kColours: return !ids && channel_count(kind) == 3 && !is_direction(kind);
    case Holds::kIds: return ids;
  }
  return false;
}

PlaneFormat wider_format(PlaneFormat format) { return traits(format).wider; }

std::optional<PlaneFormat> format_from_number(int number, PlaneKind kind) {
  if (number == 0) return full_format(kind);
  if (number < 0 || number > static_cast<int>(kTraits.size())) return std::nullopt;
  const auto format = static_cast<PlaneFormat>(number);
  return format_suits(format, kind) ? std::optional(format) : std::nullopt;
}

int format_number(PlaneFormat format, PlaneKind kind) {
  return format == full_format(kind) ? 0 : static_cast<int>(format);
}

}  // namespace holdfast::wire
