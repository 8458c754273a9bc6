#pragma once

#include <cstddef>
#include <cstdint>

#include "core/frame/plane.h"
#include "core/frame/plane_size.h"

/// The bytes of a plane on the wire: its channels one after the other, each with its rows from the
/// top, without padding, in little-endian words of 4 bytes. Shared by both ends of the protocol.
namespace holdfast::wire {

/// Largest size of the data in one chunk, bytes. One message for a whole frame costs twice the CPU
/// of 1 MiB chunks, and so do 64 KiB chunks.
inline constexpr std::size_t kMaxChunkBytes = 1u << 20;

/// Largest message that either end accepts, bytes: a chunk, or a frame's tables of transforms.
inline constexpr int kMaxMessageBytes = 8 << 20;

/// Bytes of a plane of `id` with that size.
std::size_t plane_bytes(PlaneId id, PlaneSize size);
/// Bytes of `plane`.
std::size_t plane_bytes(const Plane& plane);

/// Copies `bytes` bytes at `offset` of the plane's wire layout to `out`. Both are multiples of 4
/// and lie within the plane (asserted).
void read_plane_bytes(const Plane& plane, std::size_t offset, std::size_t bytes, void* out);
/// The inverse: copies from `in` to the plane.
void write_plane_bytes(Plane& plane, std::size_t offset, std::size_t bytes, const void* in);

}  // namespace holdfast::wire
