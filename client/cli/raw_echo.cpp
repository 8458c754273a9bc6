#include "client/cli/raw_echo.h"

#include <arpa/inet.h>
#include <netinet/tcp.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace holdfast::cli {
namespace {

constexpr std::size_t kPiece = 1u << 20;  // bytes, as the chunks of the protocol

[[noreturn]] void fail(const char* what) {
  throw std::system_error(errno, std::generic_category(), what);
}

/// Two connected sockets, closed at the end.
class Pair {
 public:
  explicit Pair(bool tcp) { tcp ? connect_tcp() : connect_unix(); }
  ~Pair() {
    for (const int fd : {ends[0], ends[1]})
      if (fd >= 0) close(fd);
  }
  Pair(const Pair&) = delete;
  Pair& operator=(const Pair&) = delete;
  int ends[2] = {-1, -1};

 private:
  void connect_unix() {
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) fail("socketpair");
  }
  void connect_tcp() {
    const int listener = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    auto* const name = reinterpret_cast<sockaddr*>(&address);
    ends[0] = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    const bool good = listener >= 0 && bind(listener, name, size) == 0 &&
                      listen(listener, 1) == 0 && getsockname(listener, name, &size) == 0 &&
                      connect(ends[0], name, size) == 0;
    if (good) ends[1] = accept(listener, nullptr, nullptr);
    const int error = errno;
    close(listener);
    errno = error;
    if (ends[1] < 0) fail("loopback connection");
    for (const int fd : ends) {
      const int on = 1;
      setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    }
  }
};

/// Sends or receives all of `buffer`; false if the other side is gone.
template <class Transfer>
bool transfer(Transfer call, int fd, std::vector<std::byte>& buffer) {
  for (std::size_t at = 0; at < buffer.size();) {
    const ssize_t moved = call(fd, buffer.data() + at, std::min(kPiece, buffer.size() - at));
    if (moved < 0 && errno == EINTR) continue;
    if (moved <= 0) return false;
    at += static_cast<std::size_t>(moved);
  }
  return true;
}

bool put(int fd, std::vector<std::byte>& buffer) {
  return transfer([](int s, const void* p, std::size_t n) { return send(s, p, n, MSG_NOSIGNAL); },
                  fd, buffer);
}

bool get(int fd, std::vector<std::byte>& buffer) {
  return transfer([](int s, void* p, std::size_t n) { return recv(s, p, n, 0); }, fd, buffer);
}

/// A count of frames that threads wait for.
class Count {
 public:
  explicit Count(int start) : left_(start) {}
  void give() {
    const std::lock_guard lock(mutex_);
    ++left_;
    changed_.notify_one();
  }
  void take() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return left_ > 0; });
    --left_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  int left_;
};

}  // namespace

double own_cpu_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

TransportCost raw_echo(bool tcp, std::size_t up, std::size_t down, int frames, int in_flight) {
  const Pair pair(tcp);
  const int client = pair.ends[0], server = pair.ends[1];
  std::vector<std::byte> asked(up, std::byte{1}), heard(up), answer(down, std::byte{1}), got(down);
  Count credits(in_flight), whole(0);
  const auto each_frame = [frames](auto work) {
    return std::thread([frames, work] {
      for (int i = 0; i < frames; ++i) work();
    });
  };
  const double cpu = own_cpu_seconds();
  const auto start = std::chrono::steady_clock::now();
  std::thread threads[] = {each_frame([&] {
                             credits.take();
                             put(client, asked);
                           }),
                           each_frame([&] {
                             get(server, heard);
                             whole.give();
                           }),
                           each_frame([&] {
                             whole.take();
                             put(server, answer);
                           }),
                           each_frame([&] {
                             get(client, got);
                             credits.give();
                           })};
  for (std::thread& thread : threads) thread.join();
  return {std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(),
          own_cpu_seconds() - cpu};
}

}  // namespace holdfast::cli
