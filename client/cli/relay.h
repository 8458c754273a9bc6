#pragma once

#include <memory>
#include <string>

namespace holdfast::cli {

/// What a network adds to a connection, in each direction by itself.
struct Link {
  double delay_ms = 0;        ///< one way, so that a round trip takes twice as long; >= 0
  double bandwidth_mbit = 0;  ///< million bits a second; 0 = no limit

  bool plain() const { return delay_ms == 0 && bandwidth_mbit == 0; }
};

/// A stand-in for a network: listens on a port of the loopback address and hands every connection
/// on to a server, late and no faster than the link. Each connection has a link of its own, whose
/// queue holds what is under way and a little more; the sender waits when it is full. Bytes are
/// neither lost nor changed, so encryption passes through.
class Relay {
 public:
  /// `server`: host:port or unix:PATH. Throws InputError for another form, std::system_error if
  /// nothing can be listened on.
  Relay(const std::string& server, const Link& link);
  /// Cuts all connections.
  ~Relay();

  /// host:port to connect to instead of the server.
  const std::string& address() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace holdfast::cli
