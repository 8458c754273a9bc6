#pragma once

#include <chrono>
#include <memory>
#include <string>

#include "server/config.h"

namespace holdfast::server {

/// A running server: session and denoise services, health and reflection.
class Server {
 public:
  /// Starts to listen. Throws InputError for a bad configuration or an address that is not free.
  explicit Server(const ServerConfig& config);
  /// Stops at once: open streams are cut.
  ~Server();

  /// What clients connect to: the listen address, with the actual port where 0 was asked for.
  const std::string& address() const;
  /// host:port of the admin port, with the actual port; empty if there is none.
  std::string admin_address() const;

  /// Shuts down in order: health and /readyz say so, new sessions and streams are refused, streams
  /// are told, frames in flight are answered. At `deadline` what is still open is cut.
  void drain(std::chrono::milliseconds deadline);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace holdfast::server
