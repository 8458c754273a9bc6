// Clients that hold places without using them: silent ones, and those that trickle.
#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <list>

#include "server/stream_deadlines.h"
#include "tests/service/raw_client.h"
#include "tests/service/served.h"

namespace holdfast {
namespace {

using namespace std::chrono_literals;
using server::StreamDeadlines;
using test::RawClient;
using test::RawStream;

constexpr StreamDeadlines::TimePoint kStart{};

TEST(StreamDeadlines, EndAStreamThatSaysNothingAndNoneThatHasGreeted) {
  StreamDeadlines deadlines(100ms, 50ms, kStart);
  EXPECT_FALSE(deadlines.passed(kStart + 99ms));
  EXPECT_TRUE(deadlines.passed(kStart + 100ms));
  deadlines.greeted();
  EXPECT_FALSE(deadlines.passed(kStart + 24h)) << "a paused game says nothing";
}

TEST(StreamDeadlines, CountFromTheBeginningOfEachFrameToItsEnd) {
  StreamDeadlines deadlines(100ms, 50ms, kStart);
  deadlines.greeted();
  deadlines.frame_begun(kStart + 200ms);
  EXPECT_FALSE(deadlines.passed(kStart + 249ms));
  EXPECT_TRUE(deadlines.passed(kStart + 250ms));
  deadlines.frame_ended();
  EXPECT_FALSE(deadlines.passed(kStart + 24h));
  deadlines.frame_begun(kStart + 300ms);
  EXPECT_FALSE(deadlines.passed(kStart + 349ms));
  EXPECT_TRUE(deadlines.passed(kStart + 350ms));
}

TEST(StreamDeadlines, LeaveOutTheTimeForWhichTheServerDoesNotRead) {
  StreamDeadlines deadlines(100ms, 50ms, kStart);
  deadlines.greeted();
  deadlines.frame_begun(kStart);
  deadlines.pause(kStart + 40ms);
  EXPECT_FALSE(deadlines.passed(kStart + 1h));
  deadlines.pause(kStart + 1h);  // the first one counts
  deadlines.resume(kStart + 2h);
  EXPECT_FALSE(deadlines.passed(kStart + 2h + 9ms));
  EXPECT_TRUE(deadlines.passed(kStart + 2h + 10ms));
}

TEST(StreamDeadlines, OfZeroAreNone) {
  StreamDeadlines deadlines(0ms, 0ms, kStart);
  EXPECT_FALSE(deadlines.passed(kStart + 24h));
  deadlines.greeted();
  deadlines.frame_begun(kStart);
  EXPECT_FALSE(deadlines.passed(kStart + 24h));
}

class SlowClient : public ::testing::Test {
 protected:
  void start() { server = std::make_unique<server::Server>(config); }
  /// A stream of a new session; what it says is the caller's.
  std::unique_ptr<RawClient> client() {
    auto made = std::make_unique<RawClient>(server->address());
    EXPECT_TRUE(made->create(frames).ok());
    return made;
  }
  /// The status with which the server ends the stream, answers read over.
  static grpc::Status end_of(RawStream& stream) {
    while (stream.read().message_case() != v1::DenoiseResponse::MESSAGE_NOT_SET) {
    }
    return stream.finish();
  }

  server::ServerConfig config = test::server_config(1);
  const DenoiserConfig frames = test::small_config();
  std::unique_ptr<server::Server> server;
};

TEST_F(SlowClient, ThatSaysNothingLosesItsStreamAndNotItsSession) {
  config.hello_timeout = 1000ms;
  start();
  const auto made = client();
  RawStream silent(*made);
  const grpc::Status status = end_of(silent);
  EXPECT_EQ(status.error_code(), grpc::StatusCode::DEADLINE_EXCEEDED);
  EXPECT_EQ(status.error_message(), "no Hello came within the limit hello-timeout-ms");
  RawStream again(*made);
  EXPECT_EQ(again.attach().credits(), 3u);
}

TEST_F(SlowClient, ThatFillsThePlacesOfAllStreamsHoldsThemNoLongerThanTheLimit) {
  config.hello_timeout = 5000ms;
  config.max_streams = 2;
  start();
  const auto silent = client(), honest = client();
  RawStream first(*silent), second(*silent);
  std::this_thread::sleep_for(500ms);  // both are there, and have long to go
  {
    RawStream third(*honest);
    EXPECT_EQ(third.finish().error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED);
  }
  end_of(first);
  end_of(second);
  // A place is free a moment after the end of its stream is known to the client.
  std::uint32_t credits = 0;
  for (int i = 0; i < 50 && credits == 0; ++i) {
    std::this_thread::sleep_for(20ms);
    RawStream third(*honest);
    credits = third.attach().credits();
    third.cancel();
  }
  EXPECT_EQ(credits, 3u);
}

TEST_F(SlowClient, ThatOpensManyStreamsInSilenceIsRefusedMoreAndOthersAreServed) {
  config.max_waiting_per_address = 3;
  start();
  const auto one = client();
  std::list<RawStream> silent;
  for (int i = 0; i < 3; ++i) silent.emplace_back(*one);
  std::this_thread::sleep_for(500ms);
  const auto deadline = std::chrono::steady_clock::now() + 30s;
  bool full = false;
  while (!full && std::chrono::steady_clock::now() < deadline) {
    RawStream stream(*one);
    stream.hello("none", "none");
    stream.read();
    full = stream.finish().error_code() == grpc::StatusCode::RESOURCE_EXHAUSTED;
  }
  ASSERT_TRUE(full);
  EXPECT_GT(silent.front().attach().credits(), 0u) << "one that speaks at last";
  RawStream after(*one);
  EXPECT_GT(after.attach().credits(), 0u) << "in the place that became free";
  for (RawStream& stream : silent) stream.cancel();
  after.cancel();
}

TEST_F(SlowClient, ThatOnlyConnectsIsHungUpOn) {
  config.hello_timeout = 200ms;
  start();
  const int fd = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in to{};
  to.sin_family = AF_INET;
  const std::string& address = server->address();
  to.sin_port =
      htons(static_cast<std::uint16_t>(std::stoi(address.substr(address.rfind(':') + 1))));
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  ASSERT_EQ(connect(fd, reinterpret_cast<const sockaddr*>(&to), sizeof(to)), 0);
  ssize_t got = 1;
  for (char buffer[256]; got > 0;) {
    pollfd ready{fd, POLLIN, 0};
    ASSERT_EQ(poll(&ready, 1, 30000), 1) << "still connected after 30 s";
    got = recv(fd, buffer, sizeof(buffer), 0);  // the server greets first
  }
  close(fd);
}

TEST_F(SlowClient, ThatTricklesLosesTheFrameAndTheStreamAndNotTheHistory) {
  config.frame_timeout = 1000ms;
  start();
  const auto made = client();
  RawStream slow(*made);
  slow.attach();
  slow.write(test::small_frame(frames, 0), frames);
  ASSERT_FALSE(slow.read_result().has_error());
  auto messages = RawStream::messages(test::small_frame(frames, 1), frames);
  slow.write(messages[0]);
  v1::DenoiseRequest crumb = messages[1];
  const std::string data = crumb.plane_chunk().data();
  std::thread trickle([&] {  // four bytes at a time, always something new
    for (std::size_t at = 0; at + 4 < data.size(); at += 4) {
      crumb.mutable_plane_chunk()->set_offset(at);
      crumb.mutable_plane_chunk()->set_data(data.substr(at, 4));
      crumb.mutable_plane_chunk()->set_last(false);
      if (!slow.write(crumb)) return;
      std::this_thread::sleep_for(10ms);
    }
  });
  const v1::FrameResult failed = slow.read_result();
  EXPECT_EQ(failed.index(), 1);
  EXPECT_EQ(failed.error().message(),
            "frame 1 must end with FrameEnd, but it is followed by nothing within the limit "
            "frame-timeout-ms");
  while (slow.read().message_case() != v1::DenoiseResponse::MESSAGE_NOT_SET) {
  }
  trickle.join();
  EXPECT_EQ(slow.finish().error_code(), grpc::StatusCode::DEADLINE_EXCEEDED);
  RawStream again(*made);
  EXPECT_EQ(again.attach().last_frame_index(), 0);
  again.write(test::small_frame(frames, 1), frames);
  const v1::FrameResult result = again.read_result();
  EXPECT_FALSE(result.has_error()) << result.error().message();
  EXPECT_FALSE(result.history_reset());
}

TEST_F(SlowClient, ThatPausesBetweenFramesIsLeftAlone) {
  config.hello_timeout = config.frame_timeout = 1000ms;
  start();
  const auto made = client();
  RawStream stream(*made);
  stream.attach();
  for (int i = 0; i < 2; ++i) {
    std::this_thread::sleep_for(1500ms);
    ASSERT_TRUE(stream.write(test::small_frame(frames, i), frames));
    EXPECT_FALSE(stream.read_result().has_error());
  }
}

}  // namespace
}  // namespace holdfast
