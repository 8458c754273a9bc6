#include "server/admin_http.h"

#include <civetweb.h>

#include <charconv>
#include <cstring>

#include "core/frame/error.h"
#include "server/live_page.h"
#include "server/random_token.h"

namespace holdfast::server {
namespace {

constexpr const char* kText = "text/plain; charset=utf-8";
constexpr const char* kHtml = "text/html; charset=utf-8";
constexpr const char* kMetrics = "text/plain; version=0.0.4; charset=utf-8";  // Prometheus

int reply(mg_connection* connection, int status, const char* type, const std::string& body,
          const std::string& policy = "default-src 'none'") {
  mg_printf(
      connection,
      "HTTP/1.1 %d %s\r\nContent-Type: %s\r\nContent-Length: %zu\r\nCache-Control: no-store\r\n"
      "Content-Security-Policy: %s\r\nX-Content-Type-Options: nosniff\r\n"
      "Referrer-Policy: no-referrer\r\nConnection: close\r\n\r\n",
      status, mg_get_response_code_text(connection, status), type, body.size(), policy.c_str());
  mg_write(connection, body.data(), body.size());
  return status;
}

int reply_page(mg_connection* connection) {
  const std::string nonce = random_hex(16);
  return reply(connection, 200, kHtml, live_page(nonce), live_page_policy(nonce));
}

/// True if the request names this server by address. A name may be one that a hostile page has made
/// to lead here (DNS rebinding), so that the browser of an operator would let it read the answer.
bool named_by_address(const mg_connection* connection) {
  const char* const header = mg_get_header(connection, "Host");
  const std::string_view host = header ? header : "";
  const std::string_view name = host.substr(0, host.find(':'));
  return name == "localhost" ||
         (!name.empty() && name.find_first_not_of("0123456789.") == name.npos);
}

/// N of /preview/N.png; 0 for any other path.
int preview_ordinal(std::string_view path) {
  constexpr std::string_view kBefore = "/preview/", kAfter = ".png";
  if (!path.starts_with(kBefore) || !path.ends_with(kAfter)) return 0;
  int ordinal = 0;
  const char* const end = path.data() + path.size() - kAfter.size();
  const auto read = std::from_chars(path.data() + kBefore.size(), end, ordinal);
  return read.ec == std::errc{} && read.ptr == end ? ordinal : 0;
}

}  // namespace

class AdminHttp::Impl {
 public:
  Impl(const std::string& listen, AdminPages shown) : pages(std::move(shown)) {
    // A probe is answered while others read metrics or look at the live page.
    const char* options[] = {"listening_ports",
                             listen.c_str(),
                             "num_threads",
                             "4",
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
    if (!named_by_address(connection))
      return reply(connection, 403, kText, "sessions are shown by the address of this server\n");
    if (path == "/") return reply_page(connection);
    if (path == "/sessions.json")
      return reply(connection, 200, "application/json", pages.sessions());
    if (const int ordinal = preview_ordinal(path); ordinal > 0)
      if (const std::string picture = pages.preview(ordinal); !picture.empty())
        return reply(connection, 200, "image/png", picture);
    return reply(connection, 404, kText,
                 "there are /, /sessions.json, /healthz, /readyz and /metrics\n");
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
