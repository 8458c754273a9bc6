#include "server/listen_address.h"

#include <netdb.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <memory>

#include "core/frame/error.h"

namespace holdfast::server {
namespace {

constexpr const char* kUnix = "unix:";

struct HostPort {
  std::string host, port;
};

[[noreturn]] void refuse(const std::string& address, const std::string& rule,
                         const std::string& value) {
  throw InputError("listen address " + address, rule, value);
}

HostPort split(const std::string& address) {
  const std::size_t colon = address.rfind(':');
  if (colon == std::string::npos || colon == 0)
    refuse(address, "must be host:port or unix:PATH", "\"" + address + "\"");
  HostPort out{address.substr(0, colon), address.substr(colon + 1)};
  if (out.host.size() > 2 && out.host.front() == '[' && out.host.back() == ']')
    out.host = out.host.substr(1, out.host.size() - 2);
  const bool digits = !out.port.empty() && out.port.size() <= 5 &&
                      out.port.find_first_not_of("0123456789") == std::string::npos;
  if (!digits || std::stoi(out.port) > 65535)
    refuse(address, "must have a port in 0..65535", "\"" + out.port + "\"");
  return out;
}

/// Closes a socket at the end of its scope.
struct Socket {
  explicit Socket(int family) : fd(socket(family, SOCK_STREAM | SOCK_CLOEXEC, 0)) {}
  ~Socket() {
    if (fd >= 0) close(fd);
  }
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;
  int fd;
};

sockaddr_un unix_name(const std::string& address) {
  const std::string path = address.substr(std::strlen(kUnix));
  sockaddr_un name{};
  if (path.empty() || path.size() >= sizeof(name.sun_path))
    refuse(address,
           "must have a path of 1.." + std::to_string(sizeof(name.sun_path) - 1) + " bytes",
           std::to_string(path.size()) + " bytes");
  name.sun_family = AF_UNIX;
  std::memcpy(name.sun_path, path.data(), path.size());
  return name;
}

void check_unix(const std::string& address) {
  const sockaddr_un name = unix_name(address);
  const Socket probe(AF_UNIX);
  if (connect(probe.fd, reinterpret_cast<const sockaddr*>(&name), sizeof(name)) == 0)
    refuse(address, "must be free", "in use: another server listens there");
}

void check_tcp(const std::string& address, const HostPort& target) {
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  hints.ai_flags = AI_PASSIVE;
  addrinfo* found = nullptr;
  if (const int rc = getaddrinfo(target.host.c_str(), target.port.c_str(), &hints, &found); rc != 0)
    refuse(address, "must be an address of this machine", gai_strerror(rc));
  const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> guard(found, freeaddrinfo);
  const Socket probe(found->ai_family);
  const int on = 1;
  setsockopt(probe.fd, SOL_SOCKET, SO_REUSEADDR, &on, sizeof(on));
  if (bind(probe.fd, found->ai_addr, found->ai_addrlen) != 0)
    refuse(address, "must be free",
           errno == EADDRINUSE ? "in use: another program listens there" : std::strerror(errno));
}

}  // namespace

void check_address_form(const std::string& address) {
  if (address.starts_with(kUnix))
    unix_name(address);
  else
    split(address);
}

void check_listen_address(const std::string& address) {
  if (address.starts_with(kUnix))
    check_unix(address);
  else
    check_tcp(address, split(address));
}

bool is_local_address(const std::string& address) {
  if (address.starts_with(kUnix)) return true;
  const std::string host = split(address).host;
  return host.starts_with("127.") || host == "::1" || host == "localhost";
}

}  // namespace holdfast::server
