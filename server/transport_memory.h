#pragma once

#include <cstddef>

#include "server/session.h"

namespace holdfast::server {

/// Scratch of a session's stream, at most, bytes: pieces of planes that are put together, decoded
/// or encoded, the memory of codecs, and that which is shared with the client. Input may be coded
/// in any session; results are where the session's wire profile says so.
std::size_t transport_bytes(const SessionConfig& config);

}  // namespace holdfast::server
