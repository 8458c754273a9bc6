// Frames as sequences of messages.
#include <cstring>
#include <exception>
#include <memory>
#include <optional>

#include "core/frame/error.h"
#include "proto/shared_cells.h"
#include "server/frame_assembler.h"
#include "tests/service/test_frames.h"
#include "tests/stability/fuzz_message.h"
#include "tests/stability/fuzz_stream_case.h"
#include "tests/stability/peak_memory.h"

namespace holdfast::test {
namespace {

constexpr std::size_t kMemoryBase = 2u << 20, kMemoryFactor = 8, kMemoryLimit = 256u << 20;
// protobuf sets that much aside, untouched, for a text that says it is as long as that.
constexpr std::size_t kLongestText = 50'000'000;
// Of shared memory: less than a server's, which takes longer to make than a case; pieces that have
// no room travel in their messages.
constexpr std::size_t kCellBytes = 16 << 10;

/// What DenoiseStream does with messages after Hello, without its threads: the same rules in the
/// same order.
class Receiver {
 public:
  /// `memory`: that the stream shares with its client; may be null.
  Receiver(const server::SessionConfig& config, const std::shared_ptr<wire::SharedMemory>& memory)
      : assembler_(config) {
    if (memory) cells_.emplace(memory, wire::SharedPart::kResults);
  }

  /// Throws InputError where the stream would end.
  void take(grpc::ByteBuffer bytes) {
    received_ += bytes.Length();
    if (wire::ChunkView* const chunk = chunks_.read(bytes); chunk != nullptr && assembler_.open())
      return within(0, [&] { add(*chunk); });
    bool parsed = false;
    within(kLongestText, [&] { parsed = wire::parse_message(bytes, request_); });
    if (!parsed) throw InputError("message", "must be a DenoiseRequest", "something else");
    within(0, [&] { handle(); });
  }
  void end() {
    if (assembler_.open()) answer(assembler_.abandon("the end of the stream"));
  }

  int good = 0, bad = 0;
  std::string problem;
  const server::FrameSlot& last() const { return slot_; }
  /// The cell that the next chunk in shared memory is read from.
  std::uint64_t next_cell() const { return taken_; }

 private:
  void handle() {
    if (request_.has_frame_begin()) {
      if (assembler_.open()) answer(assembler_.abandon("another FrameBegin"));
      return assembler_.begin(request_.frame_begin(), slot_);
    }
    if (request_.has_shared_read()) {
      if (!cells_) throw InputError("SharedRead", "must come with shared memory", "without");
      return cells_->writer.note_read(request_.shared_read().cells());
    }
    if (!assembler_.open() || !(request_.has_plane_chunk() || request_.has_frame_end()))
      throw InputError("message", "must be inside a frame", "outside");
    if (request_.has_plane_chunk()) {
      wire::ChunkView chunk = wire::view_of(request_.plane_chunk());
      add(chunk);
    } else {
      answer(assembler_.end(request_.frame_end()));
    }
  }
  void add(wire::ChunkView& chunk) {
    if (cells_ && chunk.fields.shared_bytes > 0) ++taken_;
    try {
      wire::find_shared(chunk, cells_ ? &cells_->reader : nullptr);
    } catch (const InputError&) {
      assembler_.fail(std::current_exception());
    }
    assembler_.add(chunk);
    if (!cells_) return;
    const auto read = cells_->reader.due();
    if (read && *read != taken_) problem = "other cells are told as read than were";
  }
  /// One step, which takes no more memory than what was received explains, and `more`.
  template <class Step>
  void within(std::size_t more, const Step& step) {
    const PeakMemory peak(kMemoryLimit);
    step();
    if (peak.bytes() > kMemoryBase + kMemoryFactor * received_ + more)
      problem =
          std::to_string(peak.bytes()) + " bytes for " + std::to_string(received_) + " of messages";
  }
  void answer(const server::FrameSlot& slot) {
    ++(slot.error ? bad : good);
    if (slot.error && (slot.error->code() != v1::FRAME_ERROR_CODE_INVALID_FRAME ||
                       slot.error->violation().rule().empty()))
      problem = "an error that names no rule: " + slot.error->message();
  }

  server::FrameAssembler assembler_;
  server::FrameSlot slot_;
  std::optional<wire::SharedCells> cells_;
  std::uint64_t taken_ = 0;
  wire::ChunkReader chunks_;
  v1::DenoiseRequest request_;
  std::size_t received_ = 0;  ///< bytes
};

/// `message` with the data of its chunk, if it has one, in that cell instead.
std::string shared(const std::string& message, const wire::SharedMemory& memory,
                   std::uint64_t cell) {
  v1::DenoiseRequest request;
  if (!request.ParseFromString(message) || !request.has_plane_chunk()) return message;
  v1::PlaneChunk& chunk = *request.mutable_plane_chunk();
  if (chunk.data().empty() || chunk.data().size() > memory.layout().cell_bytes) return message;
  std::memcpy(memory.cell(wire::SharedPart::kInput, cell), chunk.data().data(),
              chunk.data().size());
  chunk.set_shared_bytes(static_cast<std::uint32_t>(chunk.data().size()));
  chunk.clear_data();
  return request.SerializeAsString();
}

/// The same by a client that keeps to no rule: sizes that are wrong or as large as can be, another
/// cell, bytes that change, data besides, counts of cells that were not read.
std::string badly_shared(const std::string& message, const wire::SharedMemory& memory,
                         std::uint64_t cell, Random& random) {
  if (chance(random, 0.2)) return message;
  v1::DenoiseRequest request;
  if (chance(random, 0.02)) {
    request.mutable_shared_read()->set_cells(random.bits() >> below(random, 32));
    return request.SerializeAsString();
  }
  const std::string good = shared(message, memory, cell + (chance(random, 0.1) ? 1 : 0));
  for (std::size_t n = chance(random, 0.2) ? below(random, 20) : 0; n > 0; --n)
    *(memory.cell(wire::SharedPart::kInput, random.bits()) + below(random, kCellBytes)) =
        static_cast<std::byte>(random.bits());
  if (chance(random, 0.1)) return damaged(good, random);
  if (!request.ParseFromString(good) || !request.has_plane_chunk()) return good;
  v1::PlaneChunk& chunk = *request.mutable_plane_chunk();
  if (chance(random, 0.1)) chunk.set_shared_bytes(random.bits() >> below(random, 32));
  if (chance(random, 0.1)) chunk.set_data(std::string(below(random, 100), 'x'));
  return request.SerializeAsString();
}

/// One stream: damaged frames, then a whole one, unless it has ended before.
std::string run_stream(const server::SessionConfig& config, Random& random, ReadOutcome& outcome) {
  const auto memory =
      chance(random, 0.5) ? wire::SharedMemory::make({.cell_bytes = kCellBytes}) : nullptr;
  Receiver receiver(config, memory);
  const Frame frame = small_frame(config.denoiser, static_cast<std::int64_t>(below(random, 50)));
  bool over = false;
  try {
    for (std::size_t n = 1 + below(random, 3); n > 0; --n)
      for (const std::string& message :
           damaged_messages(frame_messages(frame, config.denoiser, any_wire(random)), random))
        receiver.take(in_pieces(
            memory ? badly_shared(message, *memory, receiver.next_cell(), random) : message,
            random));
  } catch (const InputError&) {
    ++outcome.refused;
    over = true;
    receiver.end();
  }
  if (!over) {
    for (const std::string& message : frame_messages(frame, config.denoiser, "exact"))
      receiver.take(
          in_pieces(memory ? shared(message, *memory, receiver.next_cell()) : message, random));
    if (receiver.last().error)
      return "a whole frame is refused: " + receiver.last().error->message();
    if (!same_bits(receiver.last().frame.planes, frame.planes))
      return "a whole frame has other bits";
  }
  outcome.accepted += receiver.good;
  outcome.refused += receiver.bad;
  return receiver.problem;
}

}  // namespace

ReadOutcome fuzz_frames(std::uint32_t seed) {
  ReadOutcome outcome;
  Random random(seed);
  server::SessionConfig config;
  config.denoiser = fuzz_session_config(random);
  try {
    for (int i = 0; i < 3 && outcome.problem.empty(); ++i)
      outcome.problem = run_stream(config, random, outcome);
  } catch (const std::exception& error) {
    outcome.problem = std::string("it threw: ") + error.what();
  }
  return outcome;
}

}  // namespace holdfast::test
