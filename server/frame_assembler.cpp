#include "server/frame_assembler.h"

#include <algorithm>

#include "core/frame/error.h"
#include "server/convert.h"
#include "server/status.h"

namespace holdfast::server {
namespace {

constexpr double kLongestDeadlineMs = 3.6e6;  // an hour: none, for a frame

std::string size_text(std::uint64_t width, std::uint64_t height) {
  return std::to_string(width) + "x" + std::to_string(height);
}

std::string bytes_text(std::uint64_t bytes) { return std::to_string(bytes) + " bytes"; }

/// Bytes of the plane that a chunk holds; throws InputError if its sizes break a rule.
std::uint64_t held_bytes(const wire::ChunkView& chunk, wire::PlaneCoding coding,
                         const std::string& name) {
  const bool coded = coding.codec != wire::Codec::kNone;
  const std::uint32_t plain_bytes = chunk.fields.plain_bytes;
  if (!coded && plain_bytes != 0)
    throw InputError("plain_bytes of a chunk of " + name, "must be 0 without a codec",
                     std::to_string(plain_bytes));
  const std::uint64_t bytes = coded ? plain_bytes : chunk.data_bytes;
  const std::size_t element = wire::element_bytes(coding.format);
  if (bytes == 0 || bytes > wire::kMaxChunkBytes || bytes % element != 0)
    throw InputError("chunk of " + name,
                     "must have a multiple of " + std::to_string(element) + " bytes, at least " +
                         std::to_string(element) + " and at most " +
                         std::to_string(wire::kMaxChunkBytes),
                     bytes_text(bytes));
  if (coded && chunk.data_bytes > bytes)
    throw InputError("data of a chunk of " + name, "must be at most its " + bytes_text(bytes),
                     bytes_text(chunk.data_bytes));
  return bytes;
}

}  // namespace

void FrameAssembler::begin(const v1::FrameBegin& message, FrameSlot& slot) {
  slot_ = &slot;
  slot.error.reset();
  slot.begun = std::chrono::steady_clock::now();
  slot.answer.reset();
  slot.repeated = slot.late = false;
  slot.deadline.reset();
  slot.frame.index = message.index();
  slot.epoch = message.epoch();
  progress_.assign(config_->denoiser.planes.size(), {});
  try {
    read_frame_header(message, *config_, slot.frame);
    if (message.deadline_ms() > 0)
      slot.deadline = slot.begun + std::chrono::duration_cast<std::chrono::nanoseconds>(
                                       std::chrono::duration<double, std::milli>(
                                           std::min(message.deadline_ms(), kLongestDeadlineMs)));
    for (const v1::FramePlane& plane : message.planes()) announce(plane);
    for (std::size_t i = 0; i < progress_.size(); ++i) {
      const PlaneId id = config_->denoiser.planes[i];
      if (progress_[i].size == 0)
        throw InputError("plane " + plane_name(id), "must be announced in FrameBegin", "missing");
    }
    // Planes are added before pointers to them are taken: adding may move the others.
    for (const PlaneId id : config_->denoiser.planes) {
      const auto size = plane_size(id, config_->denoiser.width, config_->denoiser.height);
      slot.frame.planes.add(id, size.width, size.height);
    }
    for (std::size_t i = 0; i < progress_.size(); ++i)
      progress_[i].plane = slot.frame.planes.find(config_->denoiser.planes[i]);
  } catch (...) {
    slot.error = frame_error_from(std::current_exception());
  }
}

void FrameAssembler::announce(const v1::FramePlane& message) {
  if (message.plane() >= progress_.size())
    throw InputError(
        "plane number " + std::to_string(message.plane()),
        "must be less than the session's " + std::to_string(progress_.size()) + " planes",
        "unknown");
  const PlaneId id = config_->denoiser.planes[message.plane()];
  Progress& progress = progress_[message.plane()];
  if (progress.size != 0)
    throw InputError("plane " + plane_name(id), "must be announced once", "announced twice");
  const auto size = plane_size(id, config_->denoiser.width, config_->denoiser.height);
  const auto width = static_cast<std::uint64_t>(size.width);
  const auto height = static_cast<std::uint64_t>(size.height);
  if (message.width_px() != width || message.height_px() != height)
    throw InputError("plane " + plane_name(id), "must be " + size_text(width, height),
                     size_text(message.width_px(), message.height_px()));
  progress.coding = wire::coding_from_numbers(id, message.format(), message.codec());
  progress.size = wire::plane_bytes(id, size, progress.coding.format);
}

void FrameAssembler::add(const wire::ChunkView& chunk) {
  if (slot_->error) return;
  try {
    write(chunk);
  } catch (...) {
    fail(std::current_exception());
  }
}

void FrameAssembler::fail(std::exception_ptr error) {
  if (!slot_->error) slot_->error = frame_error_from(std::move(error));
}

void FrameAssembler::write(const wire::ChunkView& chunk) {
  const auto& [number, offset, last, plain_bytes, shared_bytes] = chunk.fields;
  if (number >= progress_.size())
    throw InputError(
        "plane number " + std::to_string(number),
        "must be less than the session's " + std::to_string(progress_.size()) + " planes",
        "unknown");
  Progress& progress = progress_[number];
  const std::string name = "plane " + plane_name(config_->denoiser.planes[number]);
  if (progress.complete)
    throw InputError("chunk of " + name, "must not follow the plane's last chunk",
                     "at offset " + std::to_string(offset));
  const std::uint64_t bytes = held_bytes(chunk, progress.coding, name);
  if (offset != progress.received)
    throw InputError("offset of a chunk of " + name,
                     "must be " + std::to_string(progress.received) + ", where the last one ended",
                     std::to_string(offset));
  if (bytes > progress.size - progress.received)
    throw InputError(name, "must have " + bytes_text(progress.size),
                     "at least " + bytes_text(progress.received + bytes));
  if (!coder_.decode(*progress.plane, progress.coding, progress.received, bytes, chunk.data,
                     chunk.shared))
    throw InputError("data of a chunk of " + name,
                     "must be " + bytes_text(bytes) + " of " +
                         std::string(wire::codec_name(progress.coding.codec)),
                     "corrupt");
  progress.received += bytes;
  progress.complete = last;
  if (last != (progress.received == progress.size))
    throw InputError("last of a chunk of " + name,
                     "must be set exactly on the chunk that ends at " + bytes_text(progress.size),
                     (last ? "set at " : "not set at ") + bytes_text(progress.received));
}

FrameSlot& FrameAssembler::end(const v1::FrameEnd& message) {
  if (!slot_->error) try {
      const std::string frame = std::to_string(slot_->frame.index);
      if (message.index() != slot_->frame.index)
        throw InputError("index of FrameEnd", "must be " + frame + " as in FrameBegin",
                         std::to_string(message.index()));
      for (std::size_t i = 0; i < progress_.size(); ++i)
        if (!progress_[i].complete)
          throw InputError(
              "plane " + plane_name(config_->denoiser.planes[i]) + " of frame " + frame,
              "must have " + bytes_text(progress_[i].size),
              "cut off after " + bytes_text(progress_[i].received));
    } catch (...) {
      slot_->error = frame_error_from(std::current_exception());
    }
  return close();
}

FrameSlot& FrameAssembler::abandon(const char* instead) {
  if (!slot_->error)
    slot_->error = frame_error_from(std::make_exception_ptr(
        InputError("frame " + std::to_string(slot_->frame.index), "must end with FrameEnd",
                   std::string("followed by ") + instead)));
  return close();
}

FrameSlot& FrameAssembler::close() {
  slot_->ended = std::chrono::steady_clock::now();
  return *std::exchange(slot_, nullptr);
}

}  // namespace holdfast::server
