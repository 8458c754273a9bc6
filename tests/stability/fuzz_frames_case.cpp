// Frames as sequences of messages.
#include <exception>
#include <memory>
#include <optional>

#include "core/frame/error.h"
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

/// What DenoiseStream does with messages after Hello, without its threads: the same rules in the
/// same order.
class Receiver {
 public:
  explicit Receiver(const server::SessionConfig& config) : assembler_(config) {}

  /// Throws InputError where the stream would end.
  void take(grpc::ByteBuffer bytes) {
    received_ += bytes.Length();
    if (const wire::ChunkView* const chunk = chunks_.read(bytes);
        chunk != nullptr && assembler_.open())
      return within(0, [&] { assembler_.add(*chunk); });
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

 private:
  void handle() {
    if (request_.has_frame_begin()) {
      if (assembler_.open()) answer(assembler_.abandon("another FrameBegin"));
      return assembler_.begin(request_.frame_begin(), slot_);
    }
    if (!assembler_.open() || !(request_.has_plane_chunk() || request_.has_frame_end()))
      throw InputError("message", "must be inside a frame", "outside");
    if (request_.has_plane_chunk())
      assembler_.add(wire::view_of(request_.plane_chunk()));
    else
      answer(assembler_.end(request_.frame_end()));
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
  wire::ChunkReader chunks_;
  v1::DenoiseRequest request_;
  std::size_t received_ = 0;  ///< bytes
};

/// One stream: damaged frames, then a whole one, unless it has ended before.
std::string run_stream(const server::SessionConfig& config, Random& random, ReadOutcome& outcome) {
  Receiver receiver(config);
  const Frame frame = small_frame(config.denoiser, static_cast<std::int64_t>(below(random, 50)));
  bool over = false;
  try {
    for (std::size_t n = 1 + below(random, 3); n > 0; --n)
      for (const std::string& message :
           damaged_messages(frame_messages(frame, config.denoiser, any_wire(random)), random))
        receiver.take(in_pieces(message, random));
  } catch (const InputError&) {
    ++outcome.refused;
    over = true;
    receiver.end();
  }
  if (!over) {
    for (const std::string& message : frame_messages(frame, config.denoiser, "exact"))
      receiver.take(in_pieces(message, random));
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
