#pragma once

#include <memory>

#include "proto/chunk_message.h"
#include "proto/plane_coder.h"
#include "proto/shared_cells.h"

namespace holdfast::wire {

/// A message on its way out.
struct OutgoingMessage {
  grpc::ByteBuffer bytes;
  std::size_t plane_bytes = 0;   ///< data of a chunk in it
  std::size_t shared_bytes = 0;  ///< of these, in shared memory
};

/// Turns planes into messages with a PlaneChunk each. A plane whose rows lie in memory as they lie
/// on the wire (full format, no codec) is not copied: messages refer to it, to each row where
/// padding lies between them. If the rows are short, or not as on the wire, the piece is made in a
/// buffer, which is used again once its message is sent. Where there is shared memory with a free
/// cell, the piece is written there instead. One thread at a time; messages may be sent by others
/// and outlive it.
class ChunkWriter {
 public:
  ChunkWriter();

  /// From now on chunks use these cells, which outlive it; null: none.
  void use(CellWriter* cells) { cells_ = cells; }

  /// Makes `message` the chunk of `plane` that begins at `offset` of its bytes. `number` of the
  /// plane in its session. `owner` keeps the plane, which must not change, until the message is
  /// sent. Returns the offset of the next chunk, 0 if this is the last.
  std::size_t write(const Plane& plane, PlaneCoding coding, std::uint32_t number,
                    std::size_t offset, const std::shared_ptr<const void>& owner,
                    OutgoingMessage& message);

  /// Buffers that are not in use are kept, but not more: the one made and the one being sent.
  static constexpr std::size_t kKept = 2;

 private:
  class Buffers;
  void in_stream(const Plane& plane, PlaneCoding coding, std::size_t offset,
                 const std::shared_ptr<const void>& owner, std::size_t& bytes);
  std::size_t in_cell(const Plane& plane, PlaneCoding coding, std::size_t offset,
                      std::size_t& bytes);

  CellWriter* cells_ = nullptr;
  PlaneCoder coder_;
  std::shared_ptr<Buffers> buffers_;
  std::vector<grpc::Slice> data_;  ///< of the message being made
};

}  // namespace holdfast::wire
