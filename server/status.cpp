#include "server/status.h"

#include <new>

#include "core/frame/error.h"
#include "server/error.h"

namespace holdfast::server {
namespace {

v1::InputViolation violation_from(const InputError& error) {
  v1::InputViolation violation;
  violation.set_subject(error.subject());
  violation.set_rule(error.rule());
  violation.set_value(error.value());
  return violation;
}

grpc::StatusCode code_of(Refusal reason) {
  switch (reason) {
    case Refusal::kUnknownSession: return grpc::StatusCode::NOT_FOUND;
    case Refusal::kWrongToken: return grpc::StatusCode::PERMISSION_DENIED;
    case Refusal::kTakenOver: return grpc::StatusCode::ABORTED;
    case Refusal::kLimit: return grpc::StatusCode::RESOURCE_EXHAUSTED;
    case Refusal::kDraining: return grpc::StatusCode::UNAVAILABLE;
    case Refusal::kUnauthenticated: return grpc::StatusCode::UNAUTHENTICATED;
    case Refusal::kTooSlow: return grpc::StatusCode::DEADLINE_EXCEEDED;
  }
  return grpc::StatusCode::INTERNAL;
}

}  // namespace

grpc::Status status_from(std::exception_ptr error) {
  try {
    std::rethrow_exception(std::move(error));
  } catch (const InputError& e) {
    return {grpc::StatusCode::INVALID_ARGUMENT, e.what(), violation_from(e).SerializeAsString()};
  } catch (const RefusedError& e) {
    return {code_of(e.reason()), e.what()};
  } catch (const std::bad_alloc&) {
    return {grpc::StatusCode::RESOURCE_EXHAUSTED, "the server is out of memory"};
  } catch (const std::exception& e) {
    return {grpc::StatusCode::INTERNAL, e.what()};
  } catch (...) {
    return {grpc::StatusCode::INTERNAL, "unknown failure"};
  }
}

v1::FrameError frame_error_from(std::exception_ptr error) {
  v1::FrameError out;
  try {
    std::rethrow_exception(std::move(error));
  } catch (const InputError& e) {
    out.set_code(v1::FRAME_ERROR_CODE_INVALID_FRAME);
    out.set_message(e.what());
    *out.mutable_violation() = violation_from(e);
  } catch (const RefusedError& e) {
    out.set_code(v1::FRAME_ERROR_CODE_REFUSED);
    out.set_message(e.what());
  } catch (const std::exception& e) {
    out.set_code(v1::FRAME_ERROR_CODE_INTERNAL);
    out.set_message(std::string("the server failed, history was reset: ") + e.what());
  } catch (...) {
    out.set_code(v1::FRAME_ERROR_CODE_INTERNAL);
    out.set_message("the server failed, history was reset");
  }
  return out;
}

}  // namespace holdfast::server
