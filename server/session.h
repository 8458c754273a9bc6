#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "core/denoiser/denoiser.h"
#include "server/answer.h"
#include "server/memory_account.h"
#include "server/preset_chooser.h"
#include "server/scheduler.h"
#include "server/session_config.h"

namespace holdfast::server {

/// What a session has done so far.
struct SessionCounters {
  std::optional<std::int64_t> last_frame;  ///< in the history
  std::uint64_t epoch = 0;                 ///< of that frame
  std::uint64_t frames = 0;
  std::uint64_t frame_errors = 0;
  std::uint64_t repeated = 0;  ///< answered from memory
};

/// One client's configuration and history.
class Session {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;

  /// `remembered`: answers kept for frames that come again; `scratch`: what the core borrows from,
  /// shared by sessions; null: one for this session alone. Throws InputError for a configuration
  /// that the core refuses.
  Session(std::string id, std::string token, SessionConfig config, int remembered,
          std::shared_ptr<ScratchPool> scratch = {});

  const std::string& id() const { return id_; }
  const std::string& token() const { return token_; }
  /// In force; `filter` may exchange it.
  std::shared_ptr<const SessionConfig> config() const;

  /// Filters a frame; called from jobs of `strand()` only. A greater epoch than that of the frame
  /// before starts the history anew. Throws InputError for a frame that breaks a rule (history
  /// untouched); any other exception resets the history.
  /// What dropped frames left for it is added to the frame. With a budget, the preset is chosen;
  /// `complete`: when the frame had come whole, so that it is known how long others let it wait.
  /// `config`: from this frame on, of the same lights and planes; null: as it is. It holds also if
  /// the frame is refused. Where there is no memory for it, RefusedError is thrown, and the session
  /// is as before.
  std::shared_ptr<const Answer> filter(Frame& frame, std::uint64_t epoch,
                                       std::optional<TimePoint> complete = {},
                                       std::shared_ptr<const SessionConfig> config = {});
  /// Drops a frame: its cut and transforms are left for the next one. Null if the frame is not
  /// newer than the last, which `filter` then says. Called from jobs of `strand()` only.
  std::shared_ptr<const Answer> drop(const Frame& frame, std::uint64_t epoch);
  /// The answer to a frame that was filtered already; null if it was not, or too long ago. Called
  /// from jobs of `strand()` only.
  std::shared_ptr<const Answer> repeat(std::int64_t index, std::uint64_t epoch);
  /// Counts a frame that was refused before it reached `filter`.
  void count_error();
  SessionCounters counters() const;

  const std::shared_ptr<Strand>& strand() const { return strand_; }
  /// Of the core alone: Denoiser::held_bytes and scratch_bytes.
  SessionBytes denoiser_bytes() const;
  std::string plan_text() const;

 private:
  void follow(std::shared_ptr<const SessionConfig> config);
  void choose_preset();
  void note_cost(const FrameReport& report, std::optional<TimePoint> complete, TimePoint start);

  /// What dropped frames said that the next one must know.
  struct Carried {
    std::uint64_t epoch = 0;
    std::int64_t index = 0;  ///< of the last of them
    TransformTable objects, lights;
    bool cut = false;
  };

  const std::string id_, token_;
  const std::shared_ptr<ScratchPool> scratch_;
  std::shared_ptr<const SessionConfig> config_;  ///< exchanged under the mutex
  std::optional<Denoiser> denoiser_;             ///< always there but while it is made anew
  SessionBytes denoiser_bytes_;                  ///< under the mutex, as the next
  std::string plan_text_;
  std::optional<PresetChooser> chooser_;  ///< with a budget
  TimePoint last_end_{};                  ///< when the last frame was filtered
  AnswerLedger ledger_;
  std::optional<Carried> carried_;
  std::uint64_t epoch_ = 0;                       ///< of the history
  ResetReason next_reset_ = ResetReason::kFirst;  ///< of the next frame, if its history starts anew
  const std::shared_ptr<Strand> strand_ = std::make_shared<Strand>();
  mutable std::mutex mutex_;
  SessionCounters counters_;
};

/// Bytes of the frames of a session that may be in flight at once, and of the answers that are
/// remembered and made; results count whether or not they are sent back.
std::size_t frame_bytes(const DenoiserConfig& config, int credits);

/// What Denoiser::held_bytes and scratch_bytes will be, or up to a quarter more, without making one
/// of that size: images grow with the padded pixels, so a small one tells the bytes of a pixel.
/// Throws InputError for a configuration that the core refuses.
SessionBytes estimated_denoiser_bytes(const DenoiserConfig& config);

}  // namespace holdfast::server
