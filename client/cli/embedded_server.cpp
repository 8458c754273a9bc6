#include "client/cli/embedded_server.h"

#include "server/embedded.h"  // the one place where a client knows a server

namespace holdfast::cli {

class EmbeddedServer::Impl {
 public:
  // Errors of frames reach the client, which reports them; the log would only repeat them.
  explicit Impl(int threads) : server(threads, "error") {}
  server::EmbeddedServer server;
};

EmbeddedServer::EmbeddedServer(int threads) : impl_(std::make_unique<Impl>(threads)) {}
EmbeddedServer::~EmbeddedServer() = default;
const std::string& EmbeddedServer::address() const { return impl_->server.address(); }

}  // namespace holdfast::cli
