// The link between clients and server of `holdfast load`: its queue by itself, and with sockets.
#include "client/cli/relay.h"

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <random>
#include <string>
#include <thread>

#include <gtest/gtest.h>

#include "client/cli/link_queue.h"
#include "core/frame/error.h"

namespace holdfast::cli {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

double seconds(LinkQueue::Duration time) { return std::chrono::duration<double>(time).count(); }

/// Takes everything out as soon as it may come; the bytes, and when the last one came.
std::pair<std::string, LinkQueue::TimePoint> drained(LinkQueue& queue, LinkQueue::TimePoint now) {
  std::string out;
  while (!queue.empty()) {
    now = std::max(now, queue.due());
    out.append(queue.data(), queue.size());
    queue.drop(queue.size(), now);
  }
  return {out, now};
}

TEST(LinkQueue, KeepsOrderAndBytesAndDelaysEachOfThem) {
  std::mt19937 random(3);
  LinkQueue queue(0.05, 0);
  const LinkQueue::TimePoint start{};
  std::string in;
  for (int i = 0; i < 50; ++i) {
    const std::string piece(random() % 40000 + 1, static_cast<char>('a' + i % 26));
    queue.put(piece.data(), piece.size(), start + i * 1ms);
    in += piece;
  }
  EXPECT_EQ(queue.due(), start + 50ms);
  const auto [out, end] = drained(queue, start);
  EXPECT_EQ(out, in);
  EXPECT_EQ(end, start + 49ms + 50ms);
}

TEST(LinkQueue, LetsNoMoreOutThanItsRate) {
  LinkQueue queue(0, 1e6);
  const LinkQueue::TimePoint start{};
  const std::string piece(200'000, 'x');
  queue.put(piece.data(), piece.size(), start);
  const auto [out, end] = drained(queue, start);
  EXPECT_EQ(out.size(), piece.size());
  EXPECT_NEAR(seconds(end - start), 0.2, 0.02) << "but for the last piece";
}

TEST(LinkQueue, HoldsWhatIsUnderWayAndLittleMore) {
  LinkQueue queue(0.1, 1e6);
  EXPECT_EQ(queue.room(), (256u << 10) + 100'000u);
  const std::string piece(300'000, 'x');
  queue.put(piece.data(), piece.size(), {});
  EXPECT_EQ(queue.room(), (256u << 10) + 100'000u - 300'000u);
  drained(queue, {});
  EXPECT_EQ(queue.room(), (256u << 10) + 100'000u);
}

/// A server that sends back what it is sent, one connection at a time.
class Echo {
 public:
  Echo() {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof(address);
    bind(fd_, reinterpret_cast<sockaddr*>(&address), size);
    listen(fd_, 8);
    getsockname(fd_, reinterpret_cast<sockaddr*>(&address), &size);
    port = ntohs(address.sin_port);
    thread_ = std::thread([this] {
      for (int peer; (peer = accept(fd_, nullptr, nullptr)) >= 0; close(peer)) {
        char buffer[65536];
        for (ssize_t got; (got = recv(peer, buffer, sizeof(buffer), 0)) > 0;)
          send(peer, buffer, static_cast<std::size_t>(got), MSG_NOSIGNAL);
      }
    });
  }
  ~Echo() {
    shutdown(fd_, SHUT_RDWR);
    thread_.join();
    close(fd_);
  }
  int port = 0;

 private:
  const int fd_ = socket(AF_INET, SOCK_STREAM, 0);
  std::thread thread_;
};

/// What comes back through `relay` for `text`, after which the sender has said that it is done.
std::string echoed(const Relay& relay, const std::string& text) {
  const int fd = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  to.sin_port = htons(static_cast<std::uint16_t>(
      std::stoi(relay.address().substr(relay.address().rfind(':') + 1))));
  connect(fd, reinterpret_cast<sockaddr*>(&to), sizeof(to));
  std::thread sender([&] {
    for (std::size_t at = 0; at < text.size();) {
      const ssize_t sent = send(fd, text.data() + at, text.size() - at, MSG_NOSIGNAL);
      if (sent <= 0) break;
      at += static_cast<std::size_t>(sent);
    }
    shutdown(fd, SHUT_WR);
  });
  std::string out;
  char buffer[65536];
  for (ssize_t got; (got = recv(fd, buffer, sizeof(buffer), 0)) > 0;)
    out.append(buffer, static_cast<std::size_t>(got));
  sender.join();
  close(fd);
  return out;
}

std::string noise(std::size_t size) {
  std::mt19937 random(1);
  std::string text(size, '\0');
  for (char& c : text) c = static_cast<char>(random());
  return text;
}

TEST(Relay, CarriesMoreThanItHoldsWithoutALossInBothDirections) {
  const Echo echo;
  const Relay relay("127.0.0.1:" + std::to_string(echo.port), {1, 400});
  const std::string text = noise(3 << 20);
  EXPECT_TRUE(echoed(relay, text) == text);
}

TEST(Relay, AddsItsDelayEachWay) {
  const Echo echo;
  const Relay relay("127.0.0.1:" + std::to_string(echo.port), {40, 0});
  const auto start = Clock::now();
  EXPECT_EQ(echoed(relay, "ping"), "ping");
  EXPECT_GE(seconds(Clock::now() - start), 0.08);
}

TEST(Relay, IsNoFasterThanItsBandwidth) {
  const Echo echo;
  const Relay relay("127.0.0.1:" + std::to_string(echo.port), {0, 8});  // 1 MB/s
  const auto start = Clock::now();
  EXPECT_EQ(echoed(relay, noise(300'000)).size(), 300'000u);
  EXPECT_GE(seconds(Clock::now() - start), 0.25);
}

TEST(Relay, HangsUpWhereThereIsNoServer) {
  const Relay relay("127.0.0.1:1", {1, 0});
  EXPECT_EQ(echoed(relay, "ping"), "");
  EXPECT_THROW(Relay("nonsense", {}), InputError);
}

}  // namespace
}  // namespace holdfast::cli
