#pragma once

#include <functional>
#include <memory>
#include <string>

namespace holdfast::server {

/// What the admin port shows.
struct AdminPages {
  std::function<bool()> ready;
  std::function<std::string()> metrics;
  std::function<std::string()> sessions;    ///< JSON
  std::function<std::string(int)> preview;  ///< PNG of the session of that ordinal, or empty
};

/// A small HTTP server for probes and metrics, apart from the service: GET /healthz (200 while the
/// process works), /readyz (200, or 503 once new sessions are refused), /metrics (Prometheus text),
/// / (the live page) with /sessions.json and /preview/ORDINAL.png.
class AdminHttp {
 public:
  /// Listens on `address`, host:port with a numeric IPv4 host (port 0 = any free one). Throws
  /// InputError if that cannot be had.
  AdminHttp(const std::string& address, AdminPages pages);
  ~AdminHttp();

  /// host:port, with the actual port.
  const std::string& address() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace holdfast::server
