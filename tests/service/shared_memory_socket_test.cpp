// The side socket for shared memory: whom it answers, and what it stands.
#include "server/shared_memory_socket.h"

#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstring>
#include <fstream>

#include "client/sdk/shared_memory.h"
#include "holdfast/v1/shared_memory.pb.h"
#include "tests/service/raw_client.h"
#include "tests/service/served.h"
#include "tests/service/server_process.h"

namespace holdfast {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;
using client::Session;
using client::SessionOptions;
using server::SharedMemorySocket;

class SideSocket : public ::testing::Test {
 protected:
  SideSocket() {
    config.listen = directory.address();
    config.shared_memory = (directory.directory() / "memory").string();
  }
  void start() { server = std::make_unique<server::Server>(config); }
  SessionOptions options() const {
    SessionOptions out = test::session_options(*server, small);
    out.shared_memory = config.shared_memory;
    return out;
  }
  test::RawClient client_with_session() const {
    test::RawClient client(server->address());
    v1::CreateSessionRequest request;
    client::write_create_request(options(), request);
    grpc::ClientContext context;
    EXPECT_TRUE(client.sessions->CreateSession(&context, request, &client.session).ok());
    return client;
  }
  client::SharedMemoryOffer ask(const std::string& id, const std::string& token) const {
    return client::ask_for_shared_memory(config.shared_memory, id, token);
  }
  /// A caller that has said nothing yet.
  wire::Descriptor call() const {
    sockaddr_un name{};
    name.sun_family = AF_UNIX;
    std::memcpy(name.sun_path, config.shared_memory.data(), config.shared_memory.size());
    wire::Descriptor socket(::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0));
    const bool good =
        connect(socket.get(), reinterpret_cast<const sockaddr*>(&name), sizeof name) == 0;
    return good ? std::move(socket) : wire::Descriptor();
  }
  /// What the server answers to a packet; empty if it hangs up.
  std::string answer(const std::string& packet) const {
    const wire::Descriptor caller = call();
    EXPECT_EQ(send(caller.get(), packet.data(), packet.size(), MSG_NOSIGNAL),
              static_cast<ssize_t>(packet.size()));
    char buffer[4096];
    const ssize_t got = recv(caller.get(), buffer, sizeof buffer, 0);
    v1::SharedMemoryAnswer message;
    EXPECT_TRUE(got <= 0 || message.ParseFromArray(buffer, static_cast<int>(got)));
    return message.error();
  }
  static std::string request(const std::string& id, const std::string& token) {
    v1::SharedMemoryRequest message;
    message.set_session_id(id);
    message.set_token(token);
    return message.SerializeAsString();
  }

  const test::SocketAddress directory;
  const DenoiserConfig small = test::small_config();
  server::ServerConfig config = test::server_config(1);
  std::unique_ptr<server::Server> server;
};

TEST_F(SideSocket, IsOfItsUserAloneAndGoesWithItsServer) {
  start();
  struct stat status {};
  ASSERT_EQ(lstat(config.shared_memory.c_str(), &status), 0);
  EXPECT_TRUE(S_ISSOCK(status.st_mode));
  EXPECT_EQ(status.st_mode & 0777u, 0600u);
  server.reset();
  EXPECT_NE(lstat(config.shared_memory.c_str(), &status), 0);
}

TEST_F(SideSocket, TakesThePlaceOfADeadOneButNotOfALiveOneOrOfAFile) {
  {
    sockaddr_un name{};
    name.sun_family = AF_UNIX;
    std::memcpy(name.sun_path, config.shared_memory.data(), config.shared_memory.size());
    const wire::Descriptor dead(socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0));
    ASSERT_EQ(bind(dead.get(), reinterpret_cast<const sockaddr*>(&name), sizeof name), 0);
  }
  start();
  server::ServerConfig second = config;
  second.listen = "127.0.0.1:0";
  EXPECT_THROW(server::Server{second}, InputError) << "the first still listens there";
  EXPECT_TRUE(client::Session(options()).shared_memory());
  second.shared_memory = (directory.directory() / "file").string();
  std::ofstream(second.shared_memory) << "precious";
  EXPECT_THROW(server::Server{second}, InputError);
  EXPECT_TRUE(std::filesystem::exists(second.shared_memory));
  second.shared_memory = (directory.directory() / "none" / "socket").string();
  EXPECT_THROW(server::Server{second}, InputError);
  second.shared_memory = "/" + std::string(200, 'x');
  EXPECT_THROW(server::check_config(second), InputError);
  second.shared_memory = directory.directory() / "same";
  second.listen = "unix:" + second.shared_memory;
  EXPECT_THROW(server::check_config(second), InputError);
}

TEST_F(SideSocket, AnswersOnlyToTheTokenOfASessionThatWasMadeForIt) {
  start();
  const test::RawClient client = client_with_session();
  const std::string &id = client.session.session_id(), &token = client.session.token();
  const char* const unknown = "the session is unknown or has another token";
  EXPECT_EQ(answer(request(id, "wrong")), unknown);
  EXPECT_EQ(answer(request("wrong", token)), unknown);
  EXPECT_EQ(answer(request(id, "")), unknown);
  EXPECT_EQ(answer("no message"), "packet must be a SharedMemoryRequest, but it is something else");
  EXPECT_EQ(answer(std::string(100000, '\n')),
            "packet must be a SharedMemoryRequest, but it is something else");
  test::RawClient other(server->address());
  ASSERT_TRUE(other.create(small).ok());
  EXPECT_EQ(answer(request(other.session.session_id(), other.session.token())),
            "the session was not made with shared memory");
  EXPECT_TRUE(ask(id, token).memory);
  EXPECT_FALSE(ask(id, "wrong").memory);
}

TEST_F(SideSocket, OffersOneMemoryAtATimeAndEachToOneStream) {
  start();
  test::RawClient client = client_with_session();
  const auto attach = [&](const std::string& name) {
    test::RawStream stream(client);
    v1::DenoiseRequest hello;
    hello.mutable_hello()->set_session_id(client.session.session_id());
    hello.mutable_hello()->set_token(client.session.token());
    hello.mutable_hello()->set_shared_memory(name);
    stream.write(hello);
    const bool shared = stream.read().welcome().shared_memory();
    stream.writes_done();
    stream.finish();
    return shared;
  };
  const auto first = ask(client.session.session_id(), client.session.token());
  std::memset(first.memory->cell(wire::SharedPart::kInput, 0), 1, 1);
  const auto second = ask(client.session.session_id(), client.session.token());
  EXPECT_EQ(*first.memory->cell(wire::SharedPart::kInput, 0), std::byte{0}) << "given back";
  EXPECT_FALSE(attach(first.name));
  EXPECT_FALSE(attach(""));
  EXPECT_TRUE(attach(second.name));
  EXPECT_FALSE(attach(second.name)) << "its stream is gone, and it with that";
}

TEST_F(SideSocket, CallersThatHangUpOrSayNothingHoldNobodyUpForLong) {
  start();
  std::vector<wire::Descriptor> silent;
  for (std::size_t i = 0; i < 2 * SharedMemorySocket::kMostCallers; ++i) silent.push_back(call());
  for (int i = 0; i < 20; ++i) call();  // and hangs up
  const test::RawClient client = client_with_session();
  const auto start = Clock::now();
  client::SharedMemoryOffer offer;
  while (!offer.memory && Clock::now() - start < 60s)
    offer = ask(client.session.session_id(), client.session.token());
  EXPECT_TRUE(offer.memory);
  char byte = 0;
  EXPECT_EQ(recv(silent[0].get(), &byte, 1, 0), 0) << "its time is over";
}

TEST_F(SideSocket, ThatNeverAnswersOnlyDelaysASession) {
  start();
  sockaddr_un name{};
  name.sun_family = AF_UNIX;
  const std::string path = (directory.directory() / "silent").string();
  std::memcpy(name.sun_path, path.data(), path.size());
  const wire::Descriptor listener(socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0));
  ASSERT_EQ(bind(listener.get(), reinterpret_cast<const sockaddr*>(&name), sizeof name), 0);
  ASSERT_EQ(listen(listener.get(), 4), 0);
  SessionOptions asking = options();
  asking.shared_memory = path;
  Session session(asking);
  EXPECT_FALSE(session.shared_memory());
  session.submit(test::small_frame(small, 0));
  EXPECT_FALSE(session.receive()->error);
}

TEST_F(SideSocket, RefusesOtherUsersEvenWhereTheFileLetsThemIn) {
  if (geteuid() != 0) GTEST_SKIP() << "only root can become another user";
  start();
  const test::RawClient client = client_with_session();
  const std::string packet = request(client.session.session_id(), client.session.token());
  ASSERT_EQ(chmod(directory.directory().c_str(), 0711), 0);
  const auto as_nobody = [&] {
    const pid_t child = fork();
    if (child == 0) {
      if (setresuid(65534, 65534, 65534) != 0) _exit(3);
      const wire::Descriptor caller = call();
      if (!caller) _exit(1);
      send(caller.get(), packet.data(), packet.size(), MSG_NOSIGNAL);
      char byte = 0;
      _exit(recv(caller.get(), &byte, 1, 0) > 0 ? 0 : 2);
    }
    int status = 0;
    waitpid(child, &status, 0);
    return WEXITSTATUS(status);
  };
  EXPECT_EQ(as_nobody(), 1) << "the mode of the file";
  ASSERT_EQ(chmod(config.shared_memory.c_str(), 0666), 0);
  EXPECT_EQ(as_nobody(), 2) << "the user of the process";
}

}  // namespace
}  // namespace holdfast
