#pragma once

#include <memory>
#include <string>

#include <grpcpp/channel.h>

namespace holdfast::client {

/// A channel to a server, with the arguments that large planes need. Not connected yet.
std::shared_ptr<grpc::Channel> make_channel(const std::string& address);

}  // namespace holdfast::client
