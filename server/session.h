#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "core/denoiser/denoiser.h"
#include "server/scheduler.h"

namespace holdfast::server {

/// What a client fixes when it makes a session.
struct SessionConfig {
  DenoiserConfig denoiser;
  std::vector<PlaneId> results;  ///< result planes to send, in order
  double budget_ms = 0;          ///< 0 = none
  std::string wire = "exact";
};

/// What a session has done so far.
struct SessionCounters {
  std::optional<std::int64_t> last_frame;  ///< in the history
  std::uint64_t frames = 0;
  std::uint64_t frame_errors = 0;
};

/// One client's configuration and history.
class Session {
 public:
  /// Throws InputError for a configuration that the core refuses.
  Session(std::string id, std::string token, SessionConfig config);

  const std::string& id() const { return id_; }
  const std::string& token() const { return token_; }
  const SessionConfig& config() const { return config_; }

  /// Filters a frame; called from jobs of `strand()` only. Throws InputError for a frame that
  /// breaks a rule (history untouched); any other exception resets the history.
  FrameReport filter(const Frame& frame, PlaneSet& results);
  /// Counts a frame that was refused before it reached `filter`.
  void count_error();
  SessionCounters counters() const;

  const std::shared_ptr<Strand>& strand() const { return strand_; }
  /// History and scratch; see Denoiser::memory_bytes.
  std::size_t denoiser_bytes() const { return denoiser_.memory_bytes(); }
  std::string plan_text() const { return denoiser_.plan_text(); }

 private:
  const std::string id_, token_;
  const SessionConfig config_;
  Denoiser denoiser_;
  const std::shared_ptr<Strand> strand_ = std::make_shared<Strand>();
  mutable std::mutex mutex_;
  SessionCounters counters_;
};

/// Bytes of one frame in flight: its planes and its results, whether or not they are sent back.
std::size_t frame_bytes(const DenoiserConfig& config);

}  // namespace holdfast::server
