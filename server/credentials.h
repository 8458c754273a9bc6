#pragma once

#include <memory>

#include <grpcpp/security/server_credentials.h>

#include "server/config.h"

namespace holdfast::server {

/// What the service port asks of connections: nothing, TLS, or TLS with certificates of clients.
/// Files are read again within seconds of a change, so that certificates are renewed without a
/// restart; connections that are open stay as they are.
std::shared_ptr<grpc::ServerCredentials> make_credentials(const TlsConfig& config);

}  // namespace holdfast::server
