#pragma once

#include <string>

#include <grpcpp/support/status.h>

namespace holdfast::client {

/// Throws what a failed status means: InputError with the server's subject, rule and value for
/// INVALID_ARGUMENT; ConnectionError for UNAVAILABLE, UNKNOWN (a server that dies behind a proxy),
/// CANCELLED and DEADLINE_EXCEEDED; RefusedError for the rest.
[[noreturn]] void throw_status(const std::string& address, const grpc::Status& status);

}  // namespace holdfast::client
