#include "proto/plane_coder.h"

#include <algorithm>
#include <cassert>
#include <cstring>

#include "core/frame/error.h"
#include "proto/predicted_bytes.h"

namespace holdfast::wire {
namespace {

std::size_t row_elements(const Plane& plane) { return static_cast<std::size_t>(plane.width()); }

}  // namespace

PlaneCoding coding_from_numbers(PlaneId plane, int format, int codec) {
  const auto known_format = format_from_number(format, plane.kind);
  if (!known_format)
    throw InputError("format of plane " + plane_name(plane), "must be one that suits the plane",
                     std::to_string(format));
  const auto known_codec = codec_from_number(codec);
  if (!known_codec)
    throw InputError("codec of plane " + plane_name(plane), "must be a known one",
                     std::to_string(codec));
  return {*known_format, *known_codec};
}

std::size_t PlaneCoder::encode(const Plane& plane, PlaneCoding coding, std::size_t offset,
                               std::string& data) {
  const std::size_t bytes = std::min(kMaxChunkBytes, plane_bytes(plane, coding.format) - offset);
  data.resize(bytes);
  auto* const out = reinterpret_cast<std::byte*>(data.data());
  if (coding.codec == Codec::kNone) {
    read_plane_bytes(plane, coding.format, offset, bytes, out);
    return bytes;
  }
  std::byte* const plain = this->plain(2 * bytes);
  std::byte* const predicted = plain + bytes;
  read_plane_bytes(plane, coding.format, offset, bytes, plain);
  predict_bytes(plain, bytes, element_bytes(coding.format), row_elements(plane), predicted);
  if (const std::size_t size = codec_.compress(coding.codec, predicted, bytes, out))
    data.resize(size);
  else
    std::memcpy(out, plain, bytes);
  return bytes;
}

std::size_t PlaneCoder::encode_shared(const Plane& plane, PlaneCoding coding, std::size_t offset,
                                      std::byte* out, std::size_t& size) {
  if (coding.codec == Codec::kNone) {
    size = std::min(kMaxChunkBytes, plane_bytes(plane, coding.format) - offset);
    read_plane_bytes(plane, coding.format, offset, size, out);
    return size;
  }
  const std::size_t bytes =
      encode(plane, coding, offset, joined_);  // codecs may read what they made
  size = joined_.size();
  std::memcpy(out, joined_.data(), size);
  return bytes;
}

bool PlaneCoder::decode(Plane& plane, PlaneCoding coding, std::size_t offset, std::size_t bytes,
                        std::span<const std::string_view> data, bool shared) {
  assert(bytes <= kMaxChunkBytes);
  std::size_t size = 0;
  for (const std::string_view piece : data) size += piece.size();
  if (size == bytes && coding.format == full_format(plane.id().kind)) {
    for (const std::string_view piece : data) {
      write_full_bytes(plane, offset, piece);
      offset += piece.size();
    }
    return true;
  }
  const std::string_view block = joined(data, shared);
  const auto* in = reinterpret_cast<const std::byte*>(block.data());
  if (size != bytes) {
    std::byte* const plain = this->plain(2 * bytes);
    std::byte* const predicted = plain + bytes;
    if (!codec_.decompress(coding.codec, block, predicted, bytes)) return false;
    restore_bytes(predicted, bytes, element_bytes(coding.format), row_elements(plane), plain);
    in = plain;
  }
  write_plane_bytes(plane, coding.format, offset, bytes, in);
  return true;
}

/// The pieces in one, in memory of our own if they are shared.
std::string_view PlaneCoder::joined(std::span<const std::string_view> data, bool shared) {
  if (data.size() == 1 && !shared) return data.front();
  joined_.clear();
  for (const std::string_view piece : data) joined_ += piece;
  return joined_;
}

std::byte* PlaneCoder::plain(std::size_t bytes) {
  if (plain_.size() < bytes) plain_.resize(bytes);
  return plain_.data();
}

}  // namespace holdfast::wire
