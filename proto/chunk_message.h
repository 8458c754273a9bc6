#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include <grpcpp/impl/codegen/proto_utils.h>
#include <grpcpp/support/byte_buffer.h>
#include <grpcpp/support/slice.h>

/// Messages that carry a PlaneChunk, as the bytes that gRPC moves. The generated class would copy
/// the data of each chunk twice on its way; these refer to it. What is written is byte for byte
/// what the generated class writes, and whatever this cannot read is read by that class.
namespace holdfast::wire {

/// The fields of PlaneChunk but its data.
struct ChunkFields {
  std::uint32_t plane = 0;
  std::uint64_t offset = 0;
  bool last = false;
  std::uint32_t plain_bytes = 0;
  std::uint32_t shared_bytes = 0;
  friend bool operator==(const ChunkFields&, const ChunkFields&) = default;
};

/// A DenoiseRequest or DenoiseResponse, which are the same here, with a PlaneChunk of these fields.
/// `data`, in pieces one after the other, is not copied.
grpc::ByteBuffer chunk_message(const ChunkFields& fields, std::span<const grpc::Slice> data);

/// A PlaneChunk that was received; its data in the pieces in which it came.
struct ChunkView {
  ChunkFields fields;
  std::vector<std::string_view> data;
  std::size_t data_bytes = 0;
  bool shared = false;  ///< data is where the other end may write: it must be read once only
};

/// A chunk that the generated class has read; refers to its data. Valid as long as `chunk`.
template <class PlaneChunk>
ChunkView view_of(const PlaneChunk& chunk) {
  return {{chunk.plane(), chunk.offset(), chunk.last(), chunk.plain_bytes(), chunk.shared_bytes()},
          {chunk.data()},
          chunk.data().size()};
}

/// Reads messages with a PlaneChunk where they lie. Keeps its memory. One thread at a time.
class ChunkReader {
 public:
  /// The chunk in `message`, valid until the next call; null if there is none, or if it is not
  /// written in the usual way (a field twice, unknown fields, and so on): the generated class
  /// knows.
  ChunkView* read(const grpc::ByteBuffer& message);

 private:
  bool read_fields();

  std::vector<grpc::Slice> slices_;  ///< hold what `chunk_` refers to
  ChunkView chunk_;
};

/// The message in `bytes`, by the generated class; false if it is none. `bytes` is empty
/// afterwards.
template <class Message>
bool parse_message(grpc::ByteBuffer& bytes, Message& message) {
  return grpc::SerializationTraits<Message>::Deserialize(&bytes, &message).ok();
}

/// `message` as bytes, by the generated class.
template <class Message>
void write_message(const Message& message, grpc::ByteBuffer& bytes) {
  bool own = false;
  grpc::ByteBuffer made;
  if (grpc::SerializationTraits<Message>::Serialize(message, &made, &own).ok()) bytes.Swap(&made);
}

}  // namespace holdfast::wire
