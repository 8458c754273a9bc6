#pragma once

#include <chrono>
#include <stdexcept>
#include <string>

namespace holdfast::server {

/// Why a request is refused although its content breaks no rule.
enum class Refusal {
  kUnknownSession,  ///< no session of that id: never made, deleted, or expired
  kWrongToken,
  kTakenOver,        ///< a newer stream has the session
  kLimit,            ///< a limit of the server is reached
  kDraining,         ///< the server is shutting down
  kUnauthenticated,  ///< the bearer token is missing or not known
  kTooSlow,          ///< what was due did not come in time
};

/// The limit that a request met.
struct Quota {
  std::string limit;                        ///< name of the knob, such as "max-sessions"
  std::chrono::milliseconds retry_after{};  ///< another attempt may succeed then; 0 = never
};

/// A refused request; status.h translates it for the wire.
class RefusedError : public std::runtime_error {
 public:
  RefusedError(Refusal reason, const std::string& message)
      : std::runtime_error(message), reason_(reason) {}
  /// Refused for a limit.
  RefusedError(const std::string& message, Quota quota)
      : std::runtime_error(message), reason_(Refusal::kLimit), quota_(std::move(quota)) {}

  Refusal reason() const noexcept { return reason_; }
  /// Empty for other reasons.
  const Quota& quota() const noexcept { return quota_; }

 private:
  Refusal reason_;
  Quota quota_;
};

}  // namespace holdfast::server
