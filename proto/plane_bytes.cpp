#include "proto/plane_bytes.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstring>

namespace holdfast::wire {
namespace {

static_assert(std::endian::native == std::endian::little, "the wire is little endian");

/// Calls `run(channel, row, column, words, words_before)` for each run of words within one row.
template <class F>
void for_each_run(const Plane& plane, std::size_t offset, std::size_t bytes, F&& run) {
  assert(offset % 4 == 0 && bytes % 4 == 0 && offset + bytes <= plane_bytes(plane));
  const auto width = static_cast<std::size_t>(plane.width());
  const auto height = static_cast<std::size_t>(plane.height());
  const std::size_t first = offset / 4, count = bytes / 4;
  for (std::size_t done = 0; done < count;) {
    const std::size_t word = first + done;
    const std::size_t line = word / width, column = word % width;
    const std::size_t words = std::min(width - column, count - done);
    run(static_cast<int>(line / height), static_cast<int>(line % height), column, words, done);
    done += words;
  }
}

}  // namespace

std::size_t plane_bytes(PlaneId id, PlaneSize size) {
  return static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height) *
         static_cast<std::size_t>(channel_count(id.kind)) * 4;
}

std::size_t plane_bytes(const Plane& plane) {
  return plane_bytes(plane.id(), {plane.width(), plane.height()});
}

void read_plane_bytes(const Plane& plane, std::size_t offset, std::size_t bytes, void* out) {
  for_each_run(
      plane, offset, bytes, [&](int c, int y, std::size_t x, std::size_t n, std::size_t at) {
        std::memcpy(static_cast<std::byte*>(out) + at * 4, plane.words(c).row(y) + x, n * 4);
      });
}

void write_plane_bytes(Plane& plane, std::size_t offset, std::size_t bytes, const void* in) {
  for_each_run(
      plane, offset, bytes, [&](int c, int y, std::size_t x, std::size_t n, std::size_t at) {
        std::memcpy(plane.words(c).row(y) + x, static_cast<const std::byte*>(in) + at * 4, n * 4);
      });
}

}  // namespace holdfast::wire
