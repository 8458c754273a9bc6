#include "server/admin_http.h"

#include <civetweb.h>

#include <cstring>

#include "core/frame/error.h"

namespace holdfast::server {
namespace {

constexpr const char* kText = "text/plain; charset=utf-8";
constexpr const char* kMetrics = "text/plain; version=0.0.4; charset=utf-8";  // Prometheus

int reply(mg_connection* connection, int status, const char* type, const std::string& body) {
  mg_printf(
      connection,
      "HTTP/1.1 %d %s\r\nContent-Type: %s\r\nContent-Length: %zu\r\nCache-Control: no-store\r\n"
      "Connection: close\r\n\r\n",
      status, mg_get_response_code_text(connection, status), type, body.size());
  mg_write(connection, body.data(), body.size());
  return status;
}

}  // namespace

class AdminHttp::Impl {
 public:
  Impl(const std::string& listen, AdminPages shown) : pages(std::move(shown)) {
    // Two threads: a probe is answered while metrics are read.
    const char* options[] = {"listening_ports",
                             listen.c_str(),
                             "num_threads",
                             "2",
                             "request_timeout_ms",
                             "5000",
                             "enable_directory_listing",
                             "no",
                             nullptr};
    mg_callbacks callbacks{};
    callbacks.log_message = [](const mg_connection*, const char*) { return 1; };
    context = mg_start(&callbacks, this, options);
    if (!context)
      throw InputError("admin address " + listen, "must be a free IPv4 address and port",
                       "not available");
    mg_set_request_handler(context, "**", &Impl::handle, this);
    mg_server_port port{};
    mg_get_server_ports(context, 1, &port);
    address = listen.substr(0, listen.rfind(':') + 1) + std::to_string(port.port);
  }
  ~Impl() { mg_stop(context); }

  static int handle(mg_connection* connection, void* self) {
    const AdminPages& pages = static_cast<Impl*>(self)->pages;
    const mg_request_info& request = *mg_get_request_info(connection);
    const std::string path = request.local_uri ? request.local_uri : "";
    if (std::strcmp(request.request_method, "GET") != 0)
      return reply(connection, 405, kText, "only GET\n");
    if (path == "/healthz") return reply(connection, 200, kText, "ok\n");
    if (path == "/readyz")
      return pages.ready() ? reply(connection, 200, kText, "ready\n")
                           : reply(connection, 503, kText, "draining\n");
    if (path == "/metrics") return reply(connection, 200, kMetrics, pages.metrics());
    return reply(connection, 404, kText, "there are /healthz, /readyz and /metrics\n");
  }

  const AdminPages pages;
  std::string address;
  mg_context* context = nullptr;
};

AdminHttp::AdminHttp(const std::string& address, AdminPages pages)
    : impl_(std::make_unique<Impl>(address, std::move(pages))) {}
AdminHttp::~AdminHttp() = default;
const std::string& AdminHttp::address() const { return impl_->address; }

}  // namespace holdfast::server
