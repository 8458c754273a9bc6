#pragma once

#include <string>
#include <vector>

#include <grpcpp/support/byte_buffer.h>

#include "core/denoiser/denoiser.h"
#include "tests/stability/fuzz_damage.h"

namespace holdfast::test {

/// `bytes` as gRPC may hand them over: in pieces of any sizes, some of them empty.
grpc::ByteBuffer in_pieces(const std::string& bytes, Random& random);

/// A session with planes of every kind that a wire profile writes in its own way.
DenoiserConfig fuzz_session_config(Random& random);

/// Name of a wire profile.
std::string any_wire(Random& random);

/// A frame as the messages of our client.
std::vector<std::string> frame_messages(const Frame& frame, const DenoiserConfig& config,
                                        const std::string& wire);

/// Messages of which some are left out, doubled, exchanged, cut off, or wrong in a field or a byte.
std::vector<std::string> damaged_messages(std::vector<std::string> messages, Random& random);

}  // namespace holdfast::test
