// Sessions whose planes go through shared memory, end to end.
#include <filesystem>

#include "tests/service/raw_client.h"
#include "tests/service/rendered.h"
#include "tests/service/served.h"
#include "tests/service/server_process.h"

namespace holdfast {
namespace {

using namespace std::chrono_literals;
using client::FrameOutput;
using client::Session;
using client::SessionOptions;

class SharedMemorySession : public ::testing::Test {
 protected:
  std::string path() const { return (socket.directory() / "memory").string(); }
  void start(int credits = 3) {
    server::ServerConfig config = test::server_config(2, credits);
    config.listen = socket.address();
    config.shared_memory = path();
    server = std::make_unique<server::Server>(config);
  }
  SessionOptions options(const DenoiserConfig& config, const std::string& wire = "exact") const {
    SessionOptions out = test::session_options(*server, config);
    out.shared_memory = path();
    out.wire = wire;
    return out;
  }
  static FrameOutput pass(Session& session, const DenoiserConfig& of, int index) {
    session.submit(test::small_frame(of, index));
    auto output = session.receive();
    EXPECT_TRUE(output && output->index == index && !output->error);
    return std::move(*output);
  }

  const test::SocketAddress socket;
  std::unique_ptr<server::Server> server;
};

TEST_F(SharedMemorySession, GivesTheBitsOfTheStreamUnderEveryProfile) {
  start();
  for (const char* scene : {"room", "glossy-floor"}) {
    const test::Rendered rendered{scene, "reliable", 1};
    for (const std::string& wire : wire::profile_names())
      test::expect_same(test::served(options(rendered.config, wire), rendered.frames),
                        test::served(*server, rendered.config, rendered.frames, wire));
  }
}

TEST_F(SharedMemorySession, MovesPlanesOfManyPiecesWithAndWithoutPaddedRows) {
  start();
  for (const int width : {640, 641}) {
    const DenoiserConfig config = test::small_config(width, 700);
    std::vector<Frame> frames;
    for (int i = 0; i < 3; ++i) frames.push_back(test::small_frame(config, i));
    test::expect_same(test::served(options(config), frames), test::direct(config, frames));
    if (width == 641)
      test::expect_same(test::served(options(config, "compact"), frames),
                        test::served(*server, config, frames, "compact"));
  }
}

TEST_F(SharedMemorySession, GoesThroughTheStreamWhereTheServerOffersNone) {
  server = std::make_unique<server::Server>(test::server_config(1));
  const DenoiserConfig config = test::small_config();
  Session session(options(config));
  EXPECT_FALSE(session.shared_memory());
  pass(session, config, 0);
  session.close();
}

TEST_F(SharedMemorySession, GoesThroughTheStreamWhereNobodyIsAtTheSocket) {
  start();
  const DenoiserConfig config = test::small_config();
  SessionOptions elsewhere = options(config);
  elsewhere.shared_memory += "-not";
  Session session(elsewhere);
  EXPECT_FALSE(session.shared_memory());
  pass(session, config, 0);
  session.close();
  elsewhere.shared_memory = "/" + std::string(200, 'x');
  EXPECT_THROW(Session{elsewhere}, InputError);
}

TEST_F(SharedMemorySession, CountsWhatItMoves) {
  start();
  const DenoiserConfig config = test::small_config();
  Session shared(options(config)), plain(test::session_options(*server, config));
  pass(shared, config, 0);
  pass(plain, config, 0);
  EXPECT_EQ(shared.traffic().sent, plain.traffic().sent);
  EXPECT_EQ(shared.traffic().received, plain.traffic().received);
}

TEST_F(SharedMemorySession, HasItsMemoryInItsAccount) {
  start();
  test::RawClient plain(server->address()), shared(server->address());
  const DenoiserConfig config = test::small_config();
  ASSERT_TRUE(plain.create(config).ok());
  v1::CreateSessionRequest request;
  client::write_create_request(options(config), request);
  grpc::ClientContext context;
  ASSERT_TRUE(shared.sessions->CreateSession(&context, request, &shared.session).ok());
  EXPECT_TRUE(shared.session.shared_memory());
  EXPECT_FALSE(plain.session.shared_memory());
  EXPECT_EQ(shared.session.memory_bytes(),
            plain.session.memory_bytes() + wire::SharedLayout{}.bytes());
}

TEST_F(SharedMemorySession, KeepsItWhenItsSizeChanges) {
  start();
  const DenoiserConfig small = test::small_config(), large = test::small_config(700, 500);
  const auto run = [&](SessionOptions options) {
    std::vector<PlaneSet> results;
    Session session(options);
    for (int i = 0; i < 2; ++i) results.push_back(pass(session, small, i).planes);
    session.change({.width = large.width, .height = large.height, .recipe = {}, .preset = {}});
    for (int i = 2; i < 5; ++i) results.push_back(pass(session, large, i).planes);
    EXPECT_EQ(session.shared_memory(), !options.shared_memory.empty());
    session.close();
    return results;
  };
  test::expect_same(run(options(small)), run(test::session_options(*server, small)));
}

TEST_F(SharedMemorySession, AsksAnotherServerForItAfterTheLossOfTheFirst) {
  for (const char* wire : {"exact", "compact"}) {
    const auto process = [&] {
      return std::make_unique<test::ServerProcess>(
          socket.address(), std::vector<std::string>{"--shared-memory", path()});
    };
    auto running = process();
    const DenoiserConfig config = test::small_config(320, 240);
    SessionOptions options = test::session_options(socket.address(), config);
    options.wire = wire;
    options.shared_memory = path();
    options.connect_timeout = 20s;
    Session session = test::connected(options);
    ASSERT_TRUE(session.shared_memory());
    for (int i = 0; i < 4; ++i) pass(session, config, i);
    for (int i = 4; i < 7; ++i) session.submit(test::small_frame(config, i));
    running->signal(SIGKILL);
    running->wait();
    running = process();
    bool lost = false;
    for (int i = 4; i < 7; ++i) {
      const auto output = session.receive();
      ASSERT_TRUE(output && !output->error);
      EXPECT_EQ(output->index, i);
      lost |= output->history_lost;
    }
    lost |= pass(session, config, 7).history_lost;
    EXPECT_TRUE(lost);
    EXPECT_TRUE(session.shared_memory());
    session.close();
  }
}

TEST_F(SharedMemorySession, GoesOnAfterItsServerHasDrained) {
  start();
  const DenoiserConfig config = test::small_config();
  Session session(options(config));
  pass(session, config, 0);
  server->drain(5s);
  server.reset();
  start();
  EXPECT_TRUE(pass(session, config, 1).history_lost);
  EXPECT_TRUE(session.shared_memory());
  session.close();
}

}  // namespace
}  // namespace holdfast
