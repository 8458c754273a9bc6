#pragma once

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <cstring>
#include <string>
#include <thread>
#include <vector>

namespace holdfast::test {

/// A network path that can die without a word: hands connections on to the unix socket of a server,
/// until `freeze` lets those that are open carry nothing more, and closes none of them. Later ones
/// pass.
class FrozenRelay {
 public:
  explicit FrozenRelay(std::string socket) : socket_(std::move(socket)) {
    listening_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof(address);
    const auto general = reinterpret_cast<sockaddr*>(&address);
    if (bind(listening_, general, size) != 0 || listen(listening_, 16) != 0 ||
        getsockname(listening_, general, &size) != 0)
      std::abort();
    address_ = "127.0.0.1:" + std::to_string(ntohs(address.sin_port));
    thread_ = std::thread([this] { run(); });
  }
  ~FrozenRelay() {
    stopping_ = true;
    thread_.join();
    for (const Pair& pair : pairs_) close(pair.client), close(pair.server);
    close(listening_);
  }
  FrozenRelay(const FrozenRelay&) = delete;
  FrozenRelay& operator=(const FrozenRelay&) = delete;

  const std::string& address() const { return address_; }
  void freeze() { freezing_ = true; }
  int connections() const { return connections_; }

 private:
  struct Pair {
    int client, server;
    bool frozen = false, ended = false;
  };

  void run() {
    while (!stopping_) {
      if (freezing_.exchange(false))
        for (Pair& pair : pairs_) pair.frozen = true;
      std::vector<pollfd> ready{{listening_, POLLIN, 0}};
      for (const Pair& pair : pairs_) {
        const bool open = !pair.frozen && !pair.ended;
        ready.push_back({open ? pair.client : -1, POLLIN, 0});
        ready.push_back({open ? pair.server : -1, POLLIN, 0});
      }
      if (poll(ready.data(), ready.size(), 20) <= 0) continue;
      for (std::size_t k = 0; k < pairs_.size(); ++k) {
        Pair& pair = pairs_[k];
        if (ready[2 * k + 1].revents) hand_on(pair, pair.client, pair.server);
        if (ready[2 * k + 2].revents) hand_on(pair, pair.server, pair.client);
      }
      if (ready[0].revents) take_connection();
    }
  }
  void take_connection() {
    const int client = accept4(listening_, nullptr, nullptr, SOCK_CLOEXEC);
    const int server = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_un to{};
    to.sun_family = AF_UNIX;
    std::strncpy(to.sun_path, socket_.c_str(), sizeof(to.sun_path) - 1);
    const bool there = connect(server, reinterpret_cast<const sockaddr*>(&to), sizeof(to)) == 0;
    if (!there) shutdown(client, SHUT_RDWR);
    pairs_.push_back({client, server, false, !there});
    ++connections_;
  }
  static void hand_on(Pair& pair, int from, int to) {
    char buffer[64 << 10];
    const ssize_t got = recv(from, buffer, sizeof(buffer), 0);
    for (ssize_t sent = 0; sent < got;) {
      const ssize_t put =
          send(to, buffer + sent, static_cast<std::size_t>(got - sent), MSG_NOSIGNAL);
      if (put <= 0) break;
      sent += put;
    }
    if (got > 0) return;
    pair.ended = true;
    shutdown(pair.client, SHUT_RDWR);
    shutdown(pair.server, SHUT_RDWR);
  }

  const std::string socket_;
  int listening_ = -1;
  std::string address_;
  std::vector<Pair> pairs_;  ///< of the thread
  std::atomic<bool> stopping_{false}, freezing_{false};
  std::atomic<int> connections_{0};
  std::thread thread_;
};

}  // namespace holdfast::test
