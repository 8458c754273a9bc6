#pragma once

#include <stdexcept>
#include <string>

namespace holdfast::server {

/// Why a request is refused although its content breaks no rule.
enum class Refusal {
  kUnknownSession,  ///< no session of that id: never made, deleted, or expired
  kWrongToken,
  kTakenOver,  ///< a newer stream has the session
  kLimit,      ///< a limit of the server is reached
  kDraining,   ///< the server is shutting down
};

/// A refused request; status.h translates it for the wire.
class RefusedError : public std::runtime_error {
 public:
  RefusedError(Refusal reason, const std::string& message)
      : std::runtime_error(message), reason_(reason) {}
  Refusal reason() const noexcept { return reason_; }

 private:
  Refusal reason_;
};

}  // namespace holdfast::server
