#pragma once

#include <string>

namespace holdfast::server {

/// Whom a peer's address counts for, where a limit is meant for each client: an IPv4 address, or
/// the /64 network of an IPv6 address, since whoever has one of its addresses has all. `peer` as
/// gRPC writes it. Empty for what cannot be told apart, such as unix sockets.
std::string peer_network(const std::string& peer);

}  // namespace holdfast::server
