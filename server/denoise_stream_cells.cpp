// What DenoiseStream does with chunks, and with the shared memory in which their bytes may lie.
#include "core/frame/error.h"
#include "server/denoise_stream.h"

namespace holdfast::server {

using Clock = std::chrono::steady_clock;

void DenoiseStream::decode(wire::ChunkView& chunk) {
  const Clock::time_point start = Clock::now();
  try {
    wire::find_shared(chunk, cells_ ? &cells_->reader : nullptr);
  } catch (const InputError&) {
    assembler_->fail(std::current_exception());
  }
  assembler_->add(chunk);
  open_->decode += Clock::now() - start;
  if (chunk.shared) {
    shared_bytes_ = chunk.data_bytes;
    state_.metrics.received_bytes(shared_bytes_);
  }
  if (!cells_) return;
  if (const auto read = cells_->reader.due()) {
    writer_.tell_read(*read);
    write_on();
  }
}

/// Takes the memory that Hello names, if it was offered to the session.
void DenoiseStream::attach_cells(const v1::Hello& hello) {
  const auto memory = state_.shared_memory.take(*session_, hello.shared_memory());
  if (!memory) return;
  cells_.emplace(memory, wire::SharedPart::kResults);
  writer_.use(cells_->writer);
}

void DenoiseStream::note_read(const v1::SharedRead& read) {
  if (!cells_)
    throw InputError("SharedRead", "must come in a stream with shared memory", "in another");
  cells_->writer.note_read(read.cells());
  write_on();
}

/// The client may keep the memory mapped; what it does not need any more must not stay ours to pay.
void DenoiseStream::discard_cells() {
  if (!cells_) return;
  cells_->memory->discard(wire::SharedPart::kInput);
  if (cells_->writer.all_read()) cells_->memory->discard(wire::SharedPart::kResults);
}

}  // namespace holdfast::server
