#pragma once

#include <memory>

#include <grpcpp/channel.h>
#include <holdfast/client.h>

namespace holdfast::client {

/// A channel to a server, with the arguments that large planes need. Not connected yet. Throws
/// InputError naming a file that cannot be read or is none in PEM form, or a token that no header
/// can carry.
std::shared_ptr<grpc::Channel> make_channel(const SessionOptions& session);

}  // namespace holdfast::client
