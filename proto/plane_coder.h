#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/frame/plane.h"
#include "proto/codec.h"
#include "proto/plane_bytes.h"

namespace holdfast::wire {

/// How a plane is written.
struct PlaneCoding {
  PlaneFormat format = PlaneFormat::kF32;
  Codec codec = Codec::kNone;
  friend bool operator==(const PlaneCoding&, const PlaneCoding&) = default;
};

/// The coding that loses nothing and compresses nothing.
inline PlaneCoding full_coding(PlaneKind kind) { return {full_format(kind), Codec::kNone}; }

/// A coding by its numbers in the protocol. Throws InputError naming `plane`, what its format or
/// codec may be, and the number, if it is none that suits the plane.
PlaneCoding coding_from_numbers(PlaneId plane, int format, int codec);

/// Planes to and from the blocks that chunks carry: kMaxChunkBytes of a plane's bytes each, the
/// last one less; for a codec predicted from the row above (predicted_bytes.h), then compressed,
/// each by itself. Keeps its memory, three blocks at most. One thread at a time.
class PlaneCoder {
 public:
  /// Makes `data` the block of the plane that begins at `offset` of its bytes, with room for its
  /// plain bytes. Returns how many bytes of the plane it holds.
  std::size_t encode(const Plane& plane, PlaneCoding coding, std::size_t offset, std::string& data);
  /// The same to memory that others may change meanwhile, which is written only: kMaxChunkBytes at
  /// `out`. `size`: of the block.
  std::size_t encode_shared(const Plane& plane, PlaneCoding coding, std::size_t offset,
                            std::byte* out, std::size_t& size);

  /// Writes the block `data`, which holds `bytes` bytes of the plane at `offset`, to the plane:
  /// both as in write_plane_bytes, `bytes` at most kMaxChunkBytes (asserted). False, with the plane
  /// unchanged, if `data` is neither a block of the codec that holds so many bytes nor these bytes
  /// themselves.
  bool decode(Plane& plane, PlaneCoding coding, std::size_t offset, std::size_t bytes,
              std::string_view data) {
    return decode(plane, coding, offset, bytes, std::span(&data, 1));
  }
  /// The same for a block that came in pieces, at most kMaxChunkBytes together (asserted).
  /// `shared`: others may change the data meanwhile: each byte is read once.
  bool decode(Plane& plane, PlaneCoding coding, std::size_t offset, std::size_t bytes,
              std::span<const std::string_view> data, bool shared = false);

  /// Blocks of scratch that it may come to hold.
  static constexpr std::size_t kEncodeBlocks = 2, kDecodeBlocks = 3;

 private:
  std::byte* plain(std::size_t bytes);
  std::string_view joined(std::span<const std::string_view> data, bool shared);

  BlockCodec codec_;
  std::vector<std::byte> plain_;
  std::string joined_;
};

}  // namespace holdfast::wire
