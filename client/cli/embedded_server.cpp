#include "client/cli/embedded_server.h"

#include "server/embedded.h"  // the one place where a client knows a server

namespace holdfast::cli {

class EmbeddedServer::Impl {
 public:
  // Errors of frames reach the client, which reports them; the log would only repeat them.
  Impl(int threads, Link link) : server(threads, "error", link_of(link)) {}

  static server::EmbeddedServer::Link link_of(Link link) {
    switch (link) {
      case Link::kTcp: return server::EmbeddedServer::Link::kTcp;
      case Link::kSharedMemory: return server::EmbeddedServer::Link::kSharedMemory;
      case Link::kUnix: break;
    }
    return server::EmbeddedServer::Link::kUnix;
  }
  server::EmbeddedServer server;
};

EmbeddedServer::EmbeddedServer(int threads, Link link)
    : impl_(std::make_unique<Impl>(threads, link)) {}
EmbeddedServer::~EmbeddedServer() = default;
const std::string& EmbeddedServer::address() const { return impl_->server.address(); }
const std::string& EmbeddedServer::shared_memory() const { return impl_->server.shared_memory(); }

}  // namespace holdfast::cli
