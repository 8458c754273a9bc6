// Send buffers of unix sockets: whose are widened, and that sessions have them.
#include "proto/unix_buffers.h"

#include <sys/socket.h>
#include <sys/un.h>

#include <cstring>
#include <filesystem>
#include <vector>

#include "proto/shared_memory.h"
#include "tests/service/raw_client.h"
#include "tests/service/served.h"
#include "tests/service/server_process.h"

namespace holdfast {
namespace {

namespace fs = std::filesystem;
using wire::Descriptor;
using wire::widen_unix_buffers;

int send_buffer(int fd) {
  int bytes = 0;
  socklen_t size = sizeof bytes;
  EXPECT_EQ(getsockopt(fd, SOL_SOCKET, SO_SNDBUF, &bytes, &size), 0);
  return bytes;
}

/// What becomes of a buffer of 1 MiB on this machine.
int widened() {
  const Descriptor socket(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
  const int asked = 512 << 10;
  EXPECT_EQ(setsockopt(socket.get(), SOL_SOCKET, SO_SNDBUF, &asked, sizeof asked), 0);
  return send_buffer(socket.get());
}

/// A connection to a socket of the name `path`.
struct Connected {
  explicit Connected(const std::string& path)
      : listener(socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0)),
        client(socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_un name{};
    name.sun_family = AF_UNIX;
    std::memcpy(name.sun_path, path.data(), path.size());
    const auto* const address = reinterpret_cast<const sockaddr*>(&name);
    EXPECT_EQ(bind(listener.get(), address, sizeof name), 0) << std::strerror(errno);
    EXPECT_EQ(listen(listener.get(), 1), 0);
    EXPECT_EQ(connect(client.get(), address, sizeof name), 0);
    accepted = Descriptor(accept4(listener.get(), nullptr, nullptr, SOCK_CLOEXEC));
    EXPECT_GE(accepted.get(), 0);
  }
  Descriptor listener, client, accepted;
};

class UnixBuffers : public ::testing::Test {
 protected:
  void SetUp() override {
    if (widened() <= usual) GTEST_SKIP() << "buffers of this machine are as large without";
  }
  std::string path(const char* name) const { return directory.directory() / name; }
  const test::SocketAddress directory;
  const int usual = send_buffer(Descriptor(socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0)).get());
};

TEST_F(UnixBuffers, AreWidenedAtBothEndsOfTheAddressAndNowhereElse) {
  const Connected here(path("here")), other(path("other"));
  int nameless[2];
  ASSERT_EQ(socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, nameless), 0);
  const Descriptor first(nameless[0]), second(nameless[1]);
  widen_unix_buffers("unix:" + path("here"));
  EXPECT_EQ(send_buffer(here.client.get()), widened());
  EXPECT_EQ(send_buffer(here.accepted.get()), widened());
  for (const Descriptor* socket : {&other.client, &other.accepted, &first, &second})
    EXPECT_EQ(send_buffer(socket->get()), usual);
}

TEST_F(UnixBuffers, AreFoundByAnyPathToTheSocket) {
  fs::create_directory_symlink(directory.directory(), path("link"));
  for (const char* way : {"./here", "link/here", "/here"}) {
    const Connected here(path("here"));
    widen_unix_buffers("unix:" + path("") + way);
    EXPECT_EQ(send_buffer(here.client.get()), widened()) << way;
    EXPECT_EQ(send_buffer(here.accepted.get()), widened()) << way;
    fs::remove(path("here"));
  }
}

TEST_F(UnixBuffers, AreNeverMadeSmaller) {
  const Connected here(path("here"));
  const int larger = 2 << 20;
  if (setsockopt(here.client.get(), SOL_SOCKET, SO_SNDBUFFORCE, &larger, sizeof larger) != 0)
    GTEST_SKIP() << "only root may exceed the system's limit";
  const int before = send_buffer(here.client.get());
  ASSERT_GT(before, widened());
  widen_unix_buffers("unix:" + path("here"));
  EXPECT_EQ(send_buffer(here.client.get()), before);
}

TEST_F(UnixBuffers, OfOtherAddressesOrNoneAreLeftAlone) {
  const Connected here(path("here"));
  for (const std::string& address :
       {std::string("127.0.0.1:50051"), path("here"), std::string(), std::string("unix:"),
        "unix:" + path("nobody"), "unix:" + std::string(5000, 'x')})
    widen_unix_buffers(address);
  EXPECT_EQ(send_buffer(here.client.get()), usual);
  EXPECT_EQ(send_buffer(here.accepted.get()), usual);
}

/// Send buffers of this process's connections of which one end has the name `path`.
std::vector<int> connections(const std::string& path) {
  std::vector<int> buffers;
  for (int fd = 0; fd < 1024; ++fd)
    for (const auto name_of : {getsockname, getpeername}) {
      sockaddr_un name{}, peer{};
      socklen_t size = sizeof name, peer_size = sizeof peer;
      if (name_of(fd, reinterpret_cast<sockaddr*>(&name), &size) == 0 &&
          getpeername(fd, reinterpret_cast<sockaddr*>(&peer), &peer_size) == 0 &&
          name.sun_family == AF_UNIX && path == name.sun_path)
        buffers.push_back(send_buffer(fd));
    }
  return buffers;
}

TEST_F(UnixBuffers, AreWideInAServerWhosoeverItsClientIs) {
  server::ServerConfig config = test::server_config(1);
  config.listen = directory.address();
  const server::Server server(config);
  test::RawClient client(config.listen);
  ASSERT_TRUE(client.create(test::small_config()).ok());
  for (const int buffer : connections(path("socket"))) EXPECT_EQ(buffer, usual);
  test::RawStream stream(client);
  stream.attach();
  EXPECT_EQ(connections(path("socket")), (std::vector<int>{widened(), widened()}));
}

TEST_F(UnixBuffers, OfASessionAreWideBesideAServerOfAnotherProcess) {
  const test::ServerProcess server(directory.address());
  const client::Session session =
      test::connected(test::session_options(directory.address(), test::small_config()));
  EXPECT_EQ(connections(path("socket")), (std::vector<int>{widened()}));
}

}  // namespace
}  // namespace holdfast
