#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "core/frame/plane.h"
#include "core/frame/plane_size.h"
#include "proto/plane_format.h"

/// The bytes of a plane on the wire, in a format: its channels one after the other (its pixels,
/// where the format joins channels), each with its rows from the top, without padding, little
/// endian. Shared by both ends of the protocol.
namespace holdfast::wire {

/// Largest size of the data in one chunk, and of what it holds, bytes. One message for a whole
/// frame costs twice the CPU of 1 MiB chunks, and so do 64 KiB chunks.
inline constexpr std::size_t kMaxChunkBytes = 1u << 20;

/// Largest message that either end accepts, bytes: a chunk, or a frame's tables of transforms.
inline constexpr int kMaxMessageBytes = 8 << 20;

/// Bytes of a plane of `id` with that size, in its full format or another one that suits it.
std::size_t plane_bytes(PlaneId id, PlaneSize size);
std::size_t plane_bytes(PlaneId id, PlaneSize size, PlaneFormat format);
/// Bytes of `plane` in that format.
std::size_t plane_bytes(const Plane& plane, PlaneFormat format);

/// Writes `bytes` bytes at `offset` of the plane's layout to `out`. Both are multiples of
/// element_bytes(format) and lie within the plane (asserted).
void read_plane_bytes(const Plane& plane, PlaneFormat format, std::size_t offset, std::size_t bytes,
                      std::byte* out);
/// The inverse: from `in` to the plane.
void write_plane_bytes(Plane& plane, PlaneFormat format, std::size_t offset, std::size_t bytes,
                       const std::byte* in);

/// True if the plane lies in memory as in the layout of its full format, from words(0).data on.
bool is_packed(const Plane& plane);
/// Writes bytes of the full format at any byte `offset` of the layout: a piece of one that may
/// begin and end within an element.
void write_full_bytes(Plane& plane, std::size_t offset, std::string_view piece);

/// The first of `wished`, the next wider one, and so on, that holds all values of the plane, so
/// that no value changes its meaning on the way: ids are kept, infinities and NaN stay what they
/// are, nothing is clamped, and the largest value stands far above the format's smallest step.
PlaneFormat fitting_format(const Plane& plane, PlaneFormat wished);

}  // namespace holdfast::wire
