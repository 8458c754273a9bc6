// What goes wrong between a client and a server, one test for each, named by the failure.
#include <thread>

#include "tests/service/fault_fixture.h"

const char* const holdfast::test::kServerProgram = HOLDFAST_SERVER;

namespace holdfast {
namespace {

using namespace std::chrono_literals;
using test::Clock;
using test::Fault;
using test::kSlowness;
using test::RawClient;
using test::RawStream;
using test::seconds_since;
using test::ServerProcess;
using test::Session;
using test::tell_fault;

class ServerKilled : public Fault {
 protected:
  /// Kills the server under a session and starts it again.
  void kill_and_continue(const std::vector<std::string>& flags);
};

void ServerKilled::kill_and_continue(const std::vector<std::string>& flags) {
  auto server = std::make_unique<ServerProcess>(socket.address(), flags);
  Session session = connect();
  EXPECT_EQ(session.shared_memory(), !shared_memory.empty());
  for (int i = 0; i < 5; ++i) pass(session, i);
  session.submit(test::small_frame(config, 5));
  server->signal(SIGKILL);
  server->wait();
  server = std::make_unique<ServerProcess>(socket.address(), flags);
  connect().close();  // it listens
  const auto start = Clock::now();
  auto output = session.receive();
  ASSERT_TRUE(output && !output->error);
  EXPECT_EQ(output->index, 5);
  if (!output->history_lost) {  // frame 5 was answered before the end
    session.submit(test::small_frame(config, 6));
    output = session.receive();
  }
  const double recovery = seconds_since(start);
  EXPECT_LT(recovery, 1.0 * kSlowness);
  EXPECT_TRUE(output->history_lost);
  EXPECT_FALSE(output->history_reset) << "it was warmed";
  EXPECT_EQ(session.shared_memory(), !shared_memory.empty());
  session.close();
  tell_fault("the next frame, history_lost", recovery, 0);
}

TEST_F(ServerKilled, AndStartedAgainIsContinuedWarmWithinASecond) { kill_and_continue({}); }

TEST_F(ServerKilled, WhileItSharesMemoryIsContinuedWithSharedMemoryWithinASecond) {
  shared_memory = (socket.directory() / "memory").string();
  kill_and_continue({"--shared-memory", shared_memory});
}

TEST_F(Fault, ClientKilledInTheMiddleOfAFrameLeavesItsSessionAndOthersAlone) {
  const ServerProcess server(socket.address());
  Session other = connect();
  RawClient client(socket.address());
  ASSERT_TRUE(client.create(config).ok());
  {
    RawStream stream(client);
    stream.attach();
    stream.write(test::small_frame(config, 0), config);
    EXPECT_FALSE(stream.read_result().has_error());
    const auto messages = RawStream::messages(test::small_frame(config, 1), config);
    stream.write(messages[0]);
    stream.write(messages[1]);
    stream.cancel();
    stream.finish();
  }
  pass(other, 0);
  RawStream again(client);
  EXPECT_EQ(again.attach().last_frame_index(), 0) << "the half frame is not in the history";
  again.write(test::small_frame(config, 1), config);
  EXPECT_FALSE(again.read_result().history_reset());
  tell_fault("others: nothing; itself: resumed where it was", -1, 0);
}

TEST_F(Fault, SilentClientLosesItsSessionToItsOwnNewStream) {
  const ServerProcess server(socket.address());
  connect().close();
  RawClient client(socket.address());
  ASSERT_TRUE(client.create(config).ok());
  RawStream silent(client);  // as a half-open connection looks to the server
  silent.attach();
  silent.write(test::small_frame(config, 0), config);
  ASSERT_FALSE(silent.read_result().has_error());
  RawStream again(client);
  const auto start = Clock::now();
  EXPECT_TRUE(again.attach().resumed());
  const double recovery = seconds_since(start);
  EXPECT_LT(recovery, 1.0 * kSlowness);
  again.write(test::small_frame(config, 1), config);
  EXPECT_FALSE(again.read_result().history_reset());
  tell_fault("resumed by a new stream at once", recovery, 0);
}

TEST_F(Fault, FrozenServerIsWaitedForAndNothingIsLost) {
  const ServerProcess server(socket.address());
  Session session = connect();
  pass(session, 0);
  server.freeze();
  session.submit(test::small_frame(config, 1));
  std::this_thread::sleep_for(200ms);
  ASSERT_FALSE(session.try_receive()) << "there is nothing left to wait for";
  const auto start = Clock::now();
  server.signal(SIGCONT);
  EXPECT_EQ(session.receive()->index, 1);
  tell_fault("a late answer", seconds_since(start), 0);
}

TEST_F(Fault, SlowReaderStallsNobodyElse) {
  const ServerProcess server(socket.address());
  config = test::small_config(512, 400);
  Session quick = connect();
  RawClient client(socket.address());
  ASSERT_TRUE(client.create(config).ok());
  RawStream slow(client);
  slow.attach();
  std::thread writer([&] {  // more than the windows hold; nothing is read
    for (int i = 0; i < 8 && slow.write(test::small_frame(config, i), config); ++i) {
    }
  });
  std::this_thread::sleep_for(300ms);
  for (int i = 0; i < 4; ++i) pass(quick, i);
  slow.cancel();
  writer.join();
  tell_fault("others: nothing", -1, 0);
}

TEST_F(Fault, ClientFrozenInTheMiddleOfAFrameHoldsUpNeitherOthersNorTheEnd) {
  ServerProcess server(socket.address(), {"--drain-ms", "300"});
  Session other = connect();
  RawClient client(socket.address());
  ASSERT_TRUE(client.create(config).ok());
  RawStream frozen(client);
  frozen.attach();
  const auto messages = RawStream::messages(test::small_frame(config, 0), config);
  frozen.write(messages[0]);
  frozen.write(messages[1]);
  for (int i = 0; i < 3; ++i) pass(other, i);
  const auto start = Clock::now();
  server.signal(SIGTERM);
  EXPECT_EQ(server.wait(), 0);
  EXPECT_LT(seconds_since(start), 3.0 * kSlowness) << "the deadline cuts it off";
  tell_fault("others: nothing", -1, 0);
}

TEST_F(Fault, CorruptAndWrongLengthChunksFailTheirFrameAlone) {
  const ServerProcess server(socket.address());
  connect().close();
  RawClient client(socket.address());
  ASSERT_TRUE(client.create(config).ok());
  RawStream stream(client);
  stream.attach();
  const auto error_of = [&](int index, auto damage) {
    auto messages = RawStream::messages(test::small_frame(config, index), config);
    damage(*messages[1].mutable_plane_chunk());
    for (const auto& message : messages) stream.write(message);
    return stream.read_result().error().message();
  };
  const auto nothing = [](v1::PlaneChunk&) {};
  EXPECT_EQ(error_of(0, nothing), "");
  EXPECT_NE(error_of(1, [](v1::PlaneChunk& c) { c.set_offset(8); }).find("offset"),
            std::string::npos);
  EXPECT_NE(error_of(1, [](v1::PlaneChunk& c) { c.mutable_data()->resize(8); }).find("last"),
            std::string::npos);
  EXPECT_NE(error_of(1, [](v1::PlaneChunk& c) { c.mutable_data()->append("12345678"); })
                .find("must have"),
            std::string::npos);
  EXPECT_NE(error_of(1, [](v1::PlaneChunk& c) { c.set_plane(99); }).find("plane number"),
            std::string::npos);
  EXPECT_EQ(error_of(1, nothing), "");
  tell_fault("the error of that frame, by name", -1, 0);
}

TEST_F(Fault, OversizedMessageEndsTheStreamAndTheSessionStays) {
  const ServerProcess server(socket.address());
  connect().close();
  RawClient client(socket.address());
  ASSERT_TRUE(client.create(config).ok());
  {
    RawStream stream(client);
    stream.attach();
    auto message = RawStream::messages(test::small_frame(config, 0), config)[1];
    message.mutable_plane_chunk()->mutable_data()->resize(9u << 20);
    stream.write(message);
    while (stream.read().message_case() != v1::DenoiseResponse::MESSAGE_NOT_SET) {
    }
    EXPECT_FALSE(stream.finish().ok());
  }
  RawStream again(client);
  again.attach();
  again.write(test::small_frame(config, 0), config);
  EXPECT_FALSE(again.read_result().has_error());
  tell_fault("the end of the stream; resumed", -1, 0);
}

TEST_F(Fault, StopSignalUnderLoadLosesNoFrameAndEndsWell) {
  auto server = std::make_unique<ServerProcess>(socket.address());
  Session session = connect();
  std::vector<std::int64_t> answered;
  constexpr int kFrames = 60;
  std::thread load([&] {
    for (int i = 0; i < kFrames; ++i) session.submit(test::small_frame(config, i));
    session.finish();
  });
  for (int i = 0; i < 10; ++i) answered.push_back(session.receive()->index);
  server->signal(SIGTERM);
  EXPECT_EQ(server->wait(), 0) << "long before its deadline of ten seconds";
  server = std::make_unique<ServerProcess>(socket.address());
  while (const auto output = session.receive()) {
    EXPECT_FALSE(output->error);
    answered.push_back(output->index);
  }
  load.join();
  ASSERT_EQ(answered.size(), static_cast<std::size_t>(kFrames));
  for (int i = 0; i < kFrames; ++i) EXPECT_EQ(answered[static_cast<std::size_t>(i)], i);
  tell_fault("Draining, then the next server", -1, kFrames - static_cast<int>(answered.size()));
}

TEST_F(Fault, PortInUseIsNamedAndEndsTheProgram) {
  const ServerProcess first(socket.address());
  connect().close();
  ServerProcess second(socket.address());
  EXPECT_EQ(second.wait(), 2);
  EXPECT_NO_THROW(connect().close());
  tell_fault("others: nothing; exit code 2 of the second", -1, 0);
}

TEST_F(Fault, SessionLimitRefusesTheNextOneOnly) {
  const ServerProcess server(socket.address(), {"--max-sessions", "1"});
  Session first = connect();
  EXPECT_THROW(Session second(options()), client::RefusedError);
  pass(first, 0);
  tell_fault("RESOURCE_EXHAUSTED, by name", -1, 0);
}

}  // namespace
}  // namespace holdfast
