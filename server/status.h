#pragma once

#include <exception>

#include <grpcpp/support/status.h>

#include "holdfast/v1/error.pb.h"

namespace holdfast::server {

/// The one place where exceptions become gRPC statuses: InputError -> INVALID_ARGUMENT with
/// InputViolation details; RefusedError -> NOT_FOUND, PERMISSION_DENIED, ABORTED,
/// RESOURCE_EXHAUSTED, UNAVAILABLE, UNAUTHENTICATED or DEADLINE_EXCEEDED; std::bad_alloc ->
/// RESOURCE_EXHAUSTED; others
/// -> INTERNAL.
grpc::Status status_from(std::exception_ptr error);

/// The error of one frame inside a stream, from whatever its assembly or its filtering threw.
v1::FrameError frame_error_from(std::exception_ptr error);

}  // namespace holdfast::server
