#include "server/peer.h"

#include <arpa/inet.h>

#include <cstdio>

namespace holdfast::server {
namespace {

constexpr const char* kV4 = "ipv4:";
constexpr const char* kV6 = "ipv6:";

}  // namespace

std::string peer_network(const std::string& peer) {
  const std::size_t port = peer.rfind(':');
  if (peer.starts_with(kV4) && port > 4) return peer.substr(5, port - 5);
  if (!peer.starts_with(kV6) || port < 5) return {};
  // ipv6:[address]:port, the brackets as they are or as %5B and %5D.
  const std::string text = peer.substr(5, port - 5);
  const std::size_t begin = text.starts_with("%5B") ? 3 : text.starts_with("[") ? 1 : 0;
  const std::size_t end = text.find_first_of("]%", begin);
  in6_addr address{};
  if (inet_pton(AF_INET6, text.substr(begin, end - begin).c_str(), &address) != 1) return {};
  std::string network;
  for (int i = 0; i < 8; ++i) {
    char byte[3];
    std::snprintf(byte, sizeof byte, "%02x", address.s6_addr[i]);
    network += byte;
  }
  return network + "/64";
}

}  // namespace holdfast::server
