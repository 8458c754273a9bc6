#include "proto/plane_bytes.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstring>

#include "proto/format_rows.h"

namespace holdfast::wire {
namespace {

static_assert(std::endian::native == std::endian::little, "the wire is little endian");

/// A plane's words with its channels, const or not.
template <class Plane, class Word>
FormatRow<Word> row_of(Plane& plane, PlaneFormat format, std::size_t line, std::size_t column,
                       std::size_t count) {
  const auto height = static_cast<std::size_t>(plane.height());
  const bool joined = joins_channels(format);
  const int first = joined ? 0 : static_cast<int>(line / height);
  const int y = static_cast<int>(joined ? line : line % height);
  FormatRow<Word> row{{plane.words(first).row(y) + column, nullptr, nullptr}, count};
  if (joined)
    for (int c = 1; c < 3; ++c) row.words[c] = plane.words(c).row(y) + column;
  return row;
}

/// Calls `run(line, column, elements, bytes_before)` for each run of elements within one row; lines
/// count rows of one channel after the other, or of all channels at once if they are joined.
template <class F>
void for_each_run(const Plane& plane, PlaneFormat format, std::size_t offset, std::size_t bytes,
                  F&& run) {
  const std::size_t element = element_bytes(format);
  assert(offset % element == 0 && bytes % element == 0 &&
         offset + bytes <= plane_bytes(plane, format));
  const auto width = static_cast<std::size_t>(plane.width());
  const std::size_t first = offset / element, count = bytes / element;
  for (std::size_t done = 0; done < count;) {
    const std::size_t column = (first + done) % width;
    const std::size_t elements = std::min(width - column, count - done);
    run((first + done) / width, column, elements, done * element);
    done += elements;
  }
}

bool holds(PlaneFormat format, const ValueRange& range) {
  // Where half and rgb9e5 have steps of 2^-24, they are below 2^-14 of the largest value.
  constexpr float kLargestHalf = 65504.0f, kLeastLargest = 0x1p-10f, kLeastLargestUnorm = 0.25f;
  constexpr float kLargestUnorm = 1.0f + 0x1p-17f;  // sums that round a little above 1 are 1
  const float most = std::bit_cast<float>(range.most);
  const bool plain = !range.negative && !range.infinite && !range.nan;
  const auto within = [most](float least, float largest) {
    return most == 0.0f || (most >= least && most <= largest);
  };
  switch (format) {
    case PlaneFormat::kF16: return within(kLeastLargest, kLargestHalf);
    case PlaneFormat::kUnorm8:
    case PlaneFormat::kUnorm16: return plain && within(kLeastLargestUnorm, kLargestUnorm);
    case PlaneFormat::kRgb9e5: return plain && within(kLeastLargest, 65408.0f);
    case PlaneFormat::kU8: return range.most < 1u << 8;
    case PlaneFormat::kU16: return range.most < 1u << 16;
    case PlaneFormat::kF32:
    case PlaneFormat::kU32:
    case PlaneFormat::kOctahedral16: return true;
  }
  return false;
}

}  // namespace

std::size_t plane_bytes(PlaneId id, PlaneSize size) {
  return plane_bytes(id, size, full_format(id.kind));
}

std::size_t plane_bytes(PlaneId id, PlaneSize size, PlaneFormat format) {
  const std::size_t channels =
      joins_channels(format) ? 1 : static_cast<std::size_t>(channel_count(id.kind));
  return static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height) * channels *
         element_bytes(format);
}

std::size_t plane_bytes(const Plane& plane, PlaneFormat format) {
  return plane_bytes(plane.id(), {plane.width(), plane.height()}, format);
}

void read_plane_bytes(const Plane& plane, PlaneFormat format, std::size_t offset, std::size_t bytes,
                      std::byte* out) {
  for_each_run(plane, format, offset, bytes,
               [&](std::size_t line, std::size_t column, std::size_t count, std::size_t at) {
                 encode_row(
                     format,
                     row_of<const Plane, const std::uint32_t>(plane, format, line, column, count),
                     out + at);
               });
}

void write_plane_bytes(Plane& plane, PlaneFormat format, std::size_t offset, std::size_t bytes,
                       const std::byte* in) {
  for_each_run(plane, format, offset, bytes,
               [&](std::size_t line, std::size_t column, std::size_t count, std::size_t at) {
                 decode_row(format, in + at,
                            row_of<Plane, std::uint32_t>(plane, format, line, column, count));
               });
}

bool is_packed(const Plane& plane) {
  const auto first = plane.words(0), last = plane.words(plane.channels() - 1);
  return first.stride == plane.width() &&
         last.data - first.data == (plane.channels() - 1) * first.stride * plane.height();
}

void write_full_bytes(Plane& plane, std::size_t offset, std::string_view piece) {
  assert(offset + piece.size() <= plane_bytes(plane, full_format(plane.id().kind)));
  const auto height = static_cast<std::size_t>(plane.height());
  const std::size_t row = static_cast<std::size_t>(plane.width()) * sizeof(std::uint32_t);
  if (is_packed(plane)) {
    std::memcpy(reinterpret_cast<std::byte*>(plane.words(0).data) + offset, piece.data(),
                piece.size());
    return;
  }
  while (!piece.empty()) {
    const std::size_t line = offset / row, at = offset % row;
    const std::size_t bytes = std::min(row - at, piece.size());
    auto* const out = reinterpret_cast<std::byte*>(
        plane.words(static_cast<int>(line / height)).row(static_cast<int>(line % height)));
    std::memcpy(out + at, piece.data(), bytes);
    piece.remove_prefix(bytes);
    offset += bytes;
  }
}

PlaneFormat fitting_format(const Plane& plane, PlaneFormat wished) {
  if (holds(wished, {~0u, 1, 1, 1})) return wished;  // any values
  ValueRange range;
  for (int c = 0; c < plane.channels(); ++c)
    for (int y = 0; y < plane.height(); ++y) {
      const std::uint32_t* row = plane.words(c).row(y);
      const auto width = static_cast<std::size_t>(plane.width());
      plane.is_uint() ? add_id_range(row, width, range) : add_float_range(row, width, range);
    }
  while (!holds(wished, range)) wished = wider_format(wished);
  return wished;
}

}  // namespace holdfast::wire
