#include "client/cli/embedded_server.h"

#include "server/embedded.h"  // the one place where a client knows a server

namespace holdfast::cli {

class EmbeddedServer::Impl {
 public:
  // Errors of frames reach the client, which reports them; the log would only repeat them.
  Impl(int threads, Link link)
      : server(threads, "error",
               link == Link::kTcp ? server::EmbeddedServer::Link::kTcp
                                  : server::EmbeddedServer::Link::kUnix) {}
  server::EmbeddedServer server;
};

EmbeddedServer::EmbeddedServer(int threads, Link link)
    : impl_(std::make_unique<Impl>(threads, link)) {}
EmbeddedServer::~EmbeddedServer() = default;
const std::string& EmbeddedServer::address() const { return impl_->server.address(); }

}  // namespace holdfast::cli
