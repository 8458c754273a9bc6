#include "server/status.h"

#include <algorithm>
#include <new>

#include "core/frame/error.h"
#include "server/error.h"

namespace holdfast::server {
namespace {

constexpr std::size_t kLongestText = 1000;  // bytes; a status goes as headers, of 8 KiB at most

/// Bytes of the character of UTF-8 that begins at `at`; 0 if there is none.
std::size_t character_size(const std::string& text, std::size_t at) {
  const auto byte = [&](std::size_t i) {
    return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u;
  };
  const unsigned first = byte(at), second = byte(at + 1);
  if (first < 0x80) return 1;
  if (first < 0xc2 || first > 0xf4) return 0;
  // No longer than necessary, no surrogates, nothing beyond the last character.
  const bool wrong = (first == 0xe0 && second < 0xa0) || (first == 0xed && second > 0x9f) ||
                     (first == 0xf0 && second < 0x90) || (first == 0xf4 && second > 0x8f);
  const std::size_t size = first < 0xe0 ? 2 : first < 0xf0 ? 3 : 4;
  for (std::size_t i = 1; i < size; ++i)
    if (wrong || (byte(at + i) & 0xc0) != 0x80) return 0;
  return size;
}

/// Text that every client can read, whatever of its own it quotes: UTF-8 and not too long.
std::string readable(const std::string& text) {
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t size = character_size(text, at);
    if (out.size() + size >= kLongestText) return out + "...";
    out += size > 0 ? text.substr(at, size) : "?";
    at += std::max<std::size_t>(size, 1);
  }
  return out;
}

v1::InputViolation violation_from(const InputError& error) {
  v1::InputViolation violation;
  violation.set_subject(readable(error.subject()));
  violation.set_rule(readable(error.rule()));
  violation.set_value(readable(error.value()));
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
    return {grpc::StatusCode::INVALID_ARGUMENT, readable(e.what()),
            violation_from(e).SerializeAsString()};
  } catch (const RefusedError& e) {
    return {code_of(e.reason()), readable(e.what())};
  } catch (const std::bad_alloc&) {
    return {grpc::StatusCode::RESOURCE_EXHAUSTED, "the server is out of memory"};
  } catch (const std::exception& e) {
    return {grpc::StatusCode::INTERNAL, readable(e.what())};
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
    out.set_message(readable(e.what()));
    *out.mutable_violation() = violation_from(e);
  } catch (const RefusedError& e) {
    out.set_code(v1::FRAME_ERROR_CODE_REFUSED);
    out.set_message(readable(e.what()));
  } catch (const std::exception& e) {
    out.set_code(v1::FRAME_ERROR_CODE_INTERNAL);
    out.set_message(readable(std::string("the server failed, history was reset: ") + e.what()));
  } catch (...) {
    out.set_code(v1::FRAME_ERROR_CODE_INTERNAL);
    out.set_message("the server failed, history was reset");
  }
  return out;
}

}  // namespace holdfast::server
