#pragma once

#include <string>

namespace holdfast::server {

/// Checks an address to listen on: host:port with a port in 0..65535, or unix:PATH. Throws
/// InputError naming the address if it is malformed.
void check_address_form(const std::string& address);

/// The same, and throws if something listens there already (gRPC alone would share a port, and
/// would take over a socket file, without a word).
void check_listen_address(const std::string& address);

/// True for unix sockets and for 127.0.0.0/8, ::1 and localhost.
bool is_local_address(const std::string& address);

}  // namespace holdfast::server
