#include "client/cli/relay.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netdb.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <list>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "client/cli/link_queue.h"
#include "core/frame/error.h"

namespace holdfast::cli {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kLongestWaitMs = 100;  // until a thread looks whether it shall end

[[noreturn]] void fail(const char* what) {
  throw std::system_error(errno, std::generic_category(), what);
}

/// A socket, closed at the end.
class Socket {
 public:
  explicit Socket(int fd = -1) : fd_(fd) {}
  Socket(Socket&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  Socket& operator=(Socket&&) = delete;
  ~Socket() {
    if (fd_ >= 0) close(fd_);
  }
  int get() const { return fd_; }

 private:
  int fd_;
};

Socket connected(int family, const sockaddr* address, socklen_t size) {
  Socket made(socket(family, SOCK_STREAM | SOCK_CLOEXEC, 0));
  if (made.get() < 0 || connect(made.get(), address, size) != 0) return Socket();
  return made;
}

Socket connected_unix(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.size() >= sizeof(address.sun_path)) return Socket();
  std::memcpy(address.sun_path, path.c_str(), path.size());
  return connected(AF_UNIX, reinterpret_cast<const sockaddr*>(&address), sizeof(address));
}

Socket connected_tcp(const std::string& host, const std::string& port) {
  addrinfo wanted{}, *found = nullptr;
  wanted.ai_socktype = SOCK_STREAM;
  if (getaddrinfo(host.c_str(), port.c_str(), &wanted, &found) != 0) return Socket();
  const std::unique_ptr<addrinfo, void (*)(addrinfo*)> owner(found, freeaddrinfo);
  for (const addrinfo* at = found; at; at = at->ai_next) {
    Socket made = connected(at->ai_family, at->ai_addr, at->ai_addrlen);
    if (made.get() >= 0) return made;
  }
  return Socket();
}

Socket connected_to(const std::string& server) {
  if (server.starts_with("unix:")) return connected_unix(server.substr(5));
  const std::size_t colon = server.rfind(':');
  return connected_tcp(server.substr(0, colon), server.substr(colon + 1));
}

void prepare(const Socket& socket) {
  const int on = 1;
  setsockopt(socket.get(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof(on));  // a unix socket has none
  fcntl(socket.get(), F_SETFL, fcntl(socket.get(), F_GETFL) | O_NONBLOCK);
}

/// Carries one direction of a connection until its end; true if it ended well.
bool carry(int from, int to, const Link& link, const std::atomic<bool>& stopping) {
  LinkQueue queue(link.delay_ms / 1000, link.bandwidth_mbit * 1e6 / 8);
  std::vector<char> buffer(64 << 10);
  bool open = true;
  while (!stopping && (open || !queue.empty())) {
    const auto now = Clock::now();
    const bool late = !queue.empty() && queue.due() <= now;
    pollfd both[2] = {{open && queue.room() > 0 ? from : -1, POLLIN, 0},
                      {late ? to : -1, POLLOUT, 0}};
    timespec wait{0, kLongestWaitMs * 1000000L};
    if (!queue.empty() && !late)
      wait.tv_nsec = std::min(wait.tv_nsec, static_cast<long>((queue.due() - now).count()));
    if (ppoll(both, 2, &wait, nullptr) < 0) return false;
    if (both[0].revents) {
      const ssize_t got = recv(from, buffer.data(), std::min(buffer.size(), queue.room()), 0);
      if (got < 0 && errno != EAGAIN && errno != EINTR) return false;
      if (got == 0) open = false;
      if (got > 0) queue.put(buffer.data(), static_cast<std::size_t>(got), Clock::now());
    }
    if (both[1].revents) {
      const ssize_t put = send(to, queue.data(), queue.size(), MSG_NOSIGNAL);
      if (put < 0 && errno != EAGAIN && errno != EINTR) return false;
      if (put > 0) queue.drop(static_cast<std::size_t>(put), Clock::now());
    }
  }
  return !stopping;
}

}  // namespace

class Relay::Impl {
 public:
  Impl(const std::string& server, const Link& link) : server_(server), link_(link) {
    if (!server.starts_with("unix:") && server.find(':') == std::string::npos)
      throw InputError("server " + server, "must be host:port or unix:PATH", "another form");
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof(address);
    const auto general = reinterpret_cast<sockaddr*>(&address);
    if (listening_.get() < 0 || bind(listening_.get(), general, size) != 0 ||
        listen(listening_.get(), 128) != 0 || getsockname(listening_.get(), general, &size) != 0)
      fail("a relay cannot listen");
    address_ = "127.0.0.1:" + std::to_string(ntohs(address.sin_port));
    thread_ = std::thread([this] { accept_all(); });
  }
  ~Impl() {
    stopping_ = true;
    thread_.join();
    for (std::thread& thread : connections_) thread.join();
  }
  const std::string& address() const { return address_; }

 private:
  void accept_all() {
    while (!stopping_) {
      pollfd ready{listening_.get(), POLLIN, 0};
      if (poll(&ready, 1, kLongestWaitMs) <= 0) continue;
      Socket client(accept4(listening_.get(), nullptr, nullptr, SOCK_CLOEXEC));
      if (client.get() < 0) continue;
      connections_.emplace_back(
          [this, client = std::move(client)]() mutable { serve(std::move(client)); });
    }
  }
  /// Both directions of one connection. A client is hung up on if the server is not there.
  void serve(Socket client) {
    const Socket server = connected_to(server_);
    if (server.get() < 0) return;
    prepare(client);
    prepare(server);
    const auto one_way = [this](int from, int to) {
      const bool well = carry(from, to, link_, stopping_);
      shutdown(to, SHUT_WR);
      if (!well) shutdown(from, SHUT_RDWR), shutdown(to, SHUT_RDWR);  // ends the other direction
    };
    std::thread back([&] { one_way(server.get(), client.get()); });
    one_way(client.get(), server.get());
    back.join();
  }

  const std::string server_;
  const Link link_;
  const Socket listening_{socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)};
  std::string address_;
  std::atomic<bool> stopping_{false};
  std::list<std::thread> connections_;  ///< of thread_ alone, until it has ended
  std::thread thread_;
};

Relay::Relay(const std::string& server, const Link& link)
    : impl_(std::make_unique<Impl>(server, link)) {}
Relay::~Relay() = default;
const std::string& Relay::address() const { return impl_->address(); }

}  // namespace holdfast::cli
