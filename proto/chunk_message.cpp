#include "proto/chunk_message.h"

#include <array>
#include <optional>
#include <utility>

#include "holdfast/v1/denoise_service.pb.h"

namespace holdfast::wire {
namespace {

constexpr int kVarint = 0, kBytes = 2;  // wire types

constexpr std::uint8_t tag(int field, int type) {
  return static_cast<std::uint8_t>(field << 3 | type);
}

constexpr std::uint8_t kChunkTag = tag(v1::DenoiseRequest::kPlaneChunkFieldNumber, kBytes);
static_assert(int{v1::DenoiseRequest::kPlaneChunkFieldNumber} ==
              int{v1::DenoiseResponse::kPlaneChunkFieldNumber});
constexpr std::uint8_t kPlaneTag = tag(v1::PlaneChunk::kPlaneFieldNumber, kVarint);
constexpr std::uint8_t kOffsetTag = tag(v1::PlaneChunk::kOffsetFieldNumber, kVarint);
constexpr std::uint8_t kLastTag = tag(v1::PlaneChunk::kLastFieldNumber, kVarint);
constexpr std::uint8_t kDataTag = tag(v1::PlaneChunk::kDataFieldNumber, kBytes);
constexpr std::uint8_t kPlainTag = tag(v1::PlaneChunk::kPlainBytesFieldNumber, kVarint);
constexpr std::uint8_t kSharedTag = tag(v1::PlaneChunk::kSharedBytesFieldNumber, kVarint);

/// A few bytes of a message, written one after the other.
class Head {
 public:
  void byte(std::uint8_t value) { bytes_[size_++] = value; }
  void varint(std::uint64_t value) {
    for (; value >= 128; value >>= 7) byte(static_cast<std::uint8_t>(value | 128));
    byte(static_cast<std::uint8_t>(value));
  }
  /// A field, unless it has its default.
  void field(std::uint8_t field_tag, std::uint64_t value) {
    if (value == 0) return;
    byte(field_tag);
    varint(value);
  }
  void append(const Head& other) {
    for (std::size_t i = 0; i < other.size_; ++i) byte(other.bytes_[i]);
  }
  std::size_t size() const { return size_; }
  grpc::Slice slice() const { return grpc::Slice(bytes_.data(), size_); }

 private:
  std::array<std::uint8_t, 64>
      bytes_;  // 6 tags, 4 varints of at most 5 bytes, one of 10, the outer ones
  std::size_t size_ = 0;
};

/// Reads a message that lies in pieces.
class Cursor {
 public:
  explicit Cursor(const std::vector<grpc::Slice>& slices) : slices_(slices) { skip_empty(); }

  bool at_end() const { return slice_ == slices_.size(); }
  std::optional<std::uint8_t> byte() {
    if (at_end()) return {};
    const std::uint8_t value = slices_[slice_].begin()[at_];
    advance(1);
    return value;
  }
  std::optional<std::uint64_t> varint() {
    std::uint64_t value = 0;
    for (int shift = 0; shift < 64; shift += 7) {
      const auto next = byte();
      if (!next || (shift == 63 && *next > 1)) return {};
      value |= static_cast<std::uint64_t>(*next & 127) << shift;
      if (*next < 128) return value;
    }
    return {};
  }
  /// The next `bytes` bytes, in pieces; false if there are not so many.
  bool take(std::uint64_t bytes, std::vector<std::string_view>& pieces) {
    while (bytes > 0 && !at_end()) {
      const std::size_t here = slices_[slice_].size() - at_;
      const std::size_t taken = here < bytes ? here : static_cast<std::size_t>(bytes);
      pieces.emplace_back(reinterpret_cast<const char*>(slices_[slice_].begin()) + at_, taken);
      bytes -= taken;
      advance(taken);
    }
    return bytes == 0;
  }
  std::size_t left() const {
    std::size_t bytes = 0;
    for (std::size_t i = slice_; i < slices_.size(); ++i) bytes += slices_[i].size();
    return bytes - at_;
  }

 private:
  void advance(std::size_t bytes) {
    at_ += bytes;
    if (at_ < slices_[slice_].size()) return;
    ++slice_;
    skip_empty();
  }
  void skip_empty() {
    at_ = 0;
    while (!at_end() && slices_[slice_].size() == 0) ++slice_;
  }

  const std::vector<grpc::Slice>& slices_;
  std::size_t slice_ = 0, at_ = 0;
};

}  // namespace

grpc::ByteBuffer chunk_message(const ChunkFields& fields, std::span<const grpc::Slice> data) {
  std::size_t bytes = 0;
  for (const grpc::Slice& piece : data) bytes += piece.size();
  Head inner, tail, head;
  inner.field(kPlaneTag, fields.plane);
  inner.field(kOffsetTag, fields.offset);
  inner.field(kLastTag, fields.last ? 1 : 0);
  inner.field(kDataTag, bytes);  // without data there is no length either
  tail.field(kPlainTag, fields.plain_bytes);
  tail.field(kSharedTag, fields.shared_bytes);
  head.byte(kChunkTag);
  head.varint(inner.size() + bytes + tail.size());
  head.append(inner);
  if (bytes == 0) {
    head.append(tail);
    const grpc::Slice all = head.slice();
    return grpc::ByteBuffer(&all, 1);
  }
  std::vector<grpc::Slice> slices;
  slices.reserve(data.size() + 2);
  slices.push_back(head.slice());
  slices.insert(slices.end(), data.begin(), data.end());
  if (tail.size() > 0) slices.push_back(tail.slice());
  return grpc::ByteBuffer(slices.data(), slices.size());
}

ChunkView* ChunkReader::read(const grpc::ByteBuffer& message) {
  slices_.clear();
  chunk_.fields = {};
  chunk_.data.clear();
  chunk_.data_bytes = 0;
  chunk_.shared = false;
  return message.Dump(&slices_).ok() && read_fields() ? &chunk_ : nullptr;
}

bool ChunkReader::read_fields() {
  Cursor cursor(slices_);
  if (cursor.byte() != kChunkTag) return false;
  if (const auto size = cursor.varint(); !size || *size != cursor.left()) return false;
  ChunkFields& fields = chunk_.fields;
  int last_tag = 0;
  while (!cursor.at_end()) {
    const int field_tag = *cursor.byte();
    const auto value = cursor.varint();
    if (!value || field_tag <= last_tag) return false;
    last_tag = field_tag;
    if (field_tag == kOffsetTag) {
      fields.offset = *value;
    } else if (field_tag == kLastTag) {
      fields.last = *value != 0;
    } else if (field_tag == kDataTag) {
      if (!cursor.take(*value, chunk_.data)) return false;
      chunk_.data_bytes = static_cast<std::size_t>(*value);
    } else if (field_tag == kPlaneTag && *value >> 32 == 0) {
      fields.plane = static_cast<std::uint32_t>(*value);
    } else if (field_tag == kPlainTag && *value >> 32 == 0) {
      fields.plain_bytes = static_cast<std::uint32_t>(*value);
    } else if (field_tag == kSharedTag && *value >> 32 == 0) {
      fields.shared_bytes = static_cast<std::uint32_t>(*value);
    } else {
      return false;
    }
  }
  return true;
}

}  // namespace holdfast::wire
