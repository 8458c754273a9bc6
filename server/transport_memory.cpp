#include "server/transport_memory.h"

#include <algorithm>

#include "proto/chunk_writer.h"
#include "proto/shared_memory.h"

namespace holdfast::server {
namespace {

/// The largest piece that a chunk of these planes holds, bytes.
std::size_t largest_piece(const std::vector<PlaneId>& planes, const DenoiserConfig& config) {
  std::size_t most = 0;
  for (const PlaneId id : planes)
    most = std::max(most, wire::plane_bytes(id, plane_size(id, config.width, config.height)));
  return std::min(most, wire::kMaxChunkBytes);
}

}  // namespace

std::size_t transport_bytes(const SessionConfig& config) {
  using wire::BlockCodec, wire::ChunkWriter, wire::PlaneCoder;
  const bool coded = config.wire != "exact";
  const std::size_t received = largest_piece(config.denoiser.planes, config.denoiser);
  const std::size_t sent = largest_piece(config.results, config.denoiser);
  return received * PlaneCoder::kDecodeBlocks + BlockCodec::kDecompressorBytes +
         sent * (ChunkWriter::kKept + (coded ? PlaneCoder::kEncodeBlocks : 0)) +
         (coded ? BlockCodec::kCompressorBytes : 0) +
         (config.shared_memory ? wire::SharedLayout{}.bytes() : 0);
}

}  // namespace holdfast::server
