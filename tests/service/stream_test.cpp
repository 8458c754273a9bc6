#include <atomic>
#include <thread>

#include <gtest/gtest.h>

#include "server/server.h"
#include "tests/service/raw_client.h"

namespace holdfast {
namespace {

using namespace std::chrono_literals;
using test::RawClient;
using test::RawStream;

class DenoiseCall : public ::testing::Test {
 protected:
  static server::ServerConfig server_config() {
    server::ServerConfig config;
    config.listen = "127.0.0.1:0";
    config.threads = 1;
    config.limits.credits = 2;
    config.log_level = "off";
    return config;
  }

  void SetUp() override { ASSERT_TRUE(client.create(config).ok()); }

  /// The status with which a stream ends that sends `messages` after its Welcome.
  grpc::Status ends_with(const std::vector<v1::DenoiseRequest>& messages) {
    RawStream stream(client);
    stream.attach();
    for (const auto& message : messages) stream.write(message);
    stream.writes_done();
    while (stream.read().message_case() != v1::DenoiseResponse::MESSAGE_NOT_SET) {
    }
    return stream.finish();
  }

  /// A frame of the session passes.
  void expect_alive(std::int64_t index) {
    RawStream stream(client);
    EXPECT_EQ(stream.attach().credits(), 2u);
    stream.write(test::small_frame(config, index), config);
    const v1::FrameResult result = stream.read_result();
    EXPECT_EQ(result.index(), index);
    EXPECT_FALSE(result.has_error()) << result.error().message();
    stream.writes_done();
    while (stream.read().has_plane_chunk()) {
    }
    EXPECT_TRUE(stream.finish().ok());
  }

  server::Server server{server_config()};
  DenoiserConfig config = test::small_config();
  RawClient client{server.address()};
};

TEST_F(DenoiseCall, RefusesAnUnknownSession) {
  RawStream stream(client);
  stream.hello("nobody", "x");
  const grpc::Status status = stream.finish();
  EXPECT_EQ(status.error_code(), grpc::StatusCode::NOT_FOUND);
  EXPECT_EQ(status.error_message(),
            "session \"nobody\" is unknown: never made, deleted or expired");
}

TEST_F(DenoiseCall, RefusesAWrongToken) {
  RawStream stream(client);
  stream.hello(client.session.session_id(), "guess");
  const grpc::Status status = stream.finish();
  EXPECT_EQ(status.error_code(), grpc::StatusCode::PERMISSION_DENIED);
  EXPECT_EQ(status.error_message().find(client.session.token()), std::string::npos);
  expect_alive(0);
}

TEST_F(DenoiseCall, GivesASessionToItsNewestStreamAndTellsTheOlderOne) {
  RawStream first(client);
  first.attach();
  first.write(test::small_frame(config, 0), config);
  EXPECT_FALSE(first.read_result().has_error());
  RawStream second(client);
  EXPECT_EQ(second.attach().last_frame_index(), 0);
  while (first.read().message_case() != v1::DenoiseResponse::MESSAGE_NOT_SET) {
  }
  const grpc::Status status = first.finish();
  EXPECT_EQ(status.error_code(), grpc::StatusCode::ABORTED);
  EXPECT_EQ(status.error_message(), "a newer stream has the session");
  EXPECT_TRUE(client.get().streaming()) << "the end of the older stream detaches nothing";
  second.write(test::small_frame(config, 1), config);
  const v1::FrameResult result = second.read_result();
  EXPECT_FALSE(result.has_error());
  EXPECT_FALSE(result.history_reset());
}

TEST_F(DenoiseCall, LeavesOneStreamAliveWhenManyTakeASessionOverAtOnce) {
  constexpr int kStreams = 6;
  for (int round = 0; round < 5; ++round) {
    std::vector<std::unique_ptr<RawStream>> streams;
    for (int i = 0; i < kStreams; ++i) streams.push_back(std::make_unique<RawStream>(client));
    std::atomic<int> ended{0};
    std::vector<std::thread> threads;
    for (auto& stream : streams)
      threads.emplace_back([&] {
        stream->hello(client.session.session_id(), client.session.token());
        while (stream->read().message_case() != v1::DenoiseResponse::MESSAGE_NOT_SET) {
        }
        ++ended;
      });
    for (int i = 0; i < 1000 && ended < kStreams - 1; ++i) std::this_thread::sleep_for(5ms);
    std::this_thread::sleep_for(20ms);
    EXPECT_EQ(ended, kStreams - 1);
    EXPECT_TRUE(client.get().streaming());
    for (auto& stream : streams) stream->cancel();
    for (std::thread& thread : threads) thread.join();
  }
}

TEST_F(DenoiseCall, AnswersARepeatedFrameWithTheSameBitsAndFiltersItOnce) {
  const auto answer = [&](RawStream& stream, int index) {
    stream.write(test::small_frame(config, index), config);
    v1::FrameResult result = stream.read_result();
    EXPECT_FALSE(result.has_error()) << result.error().message();
    std::string data;
    for (int plane = 0; plane < result.planes_size(); ++plane)
      data += stream.read().plane_chunk().data();
    return std::pair(result, data);
  };
  RawStream stream(client);
  stream.attach();
  const auto first = answer(stream, 0), second = answer(stream, 1);
  const auto again = answer(stream, 1), older = answer(stream, 0);
  EXPECT_FALSE(second.first.repeated());
  EXPECT_TRUE(again.first.repeated());
  EXPECT_EQ(again.second, second.second);
  EXPECT_EQ(older.second, first.second);
  EXPECT_EQ(client.get().frames(), 2u);
  answer(stream, 2);
  stream.write(test::small_frame(config, 0), config);
  EXPECT_EQ(stream.read_result().error().violation().subject(), "frame index")
      << "as many are remembered as may be in flight: two";
}

TEST_F(DenoiseCall, StartsHistoryAnewAtAGreaterEpochAndRefusesASmallerOne) {
  RawStream stream(client);
  stream.attach();
  const auto send = [&](int index, std::uint64_t epoch) {
    auto messages = RawStream::messages(test::small_frame(config, index), config);
    messages[0].mutable_frame_begin()->set_epoch(epoch);
    for (const auto& message : messages) stream.write(message);
    return stream.read_result();
  };
  EXPECT_TRUE(send(5, 0).history_reset());
  EXPECT_FALSE(send(6, 0).history_reset());
  EXPECT_TRUE(send(5, 1).history_reset()) << "and its index is no repetition";
  EXPECT_FALSE(send(6, 1).history_reset());
  EXPECT_EQ(send(7, 0).error().message(), "epoch of frame 7 must be at least 1, but it is 0");
  EXPECT_FALSE(send(7, 1).history_reset()) << "the refused frame changed nothing";
}

TEST_F(DenoiseCall, EndsWithANamedErrorWhenAMessageIsOutOfPlace) {
  const auto messages = RawStream::messages(test::small_frame(config, 0), config);
  v1::DenoiseRequest hello;
  hello.mutable_hello()->set_session_id("again");
  const auto message = [&](const std::vector<v1::DenoiseRequest>& sent) {
    const grpc::Status status = ends_with(sent);
    EXPECT_EQ(status.error_code(), grpc::StatusCode::INVALID_ARGUMENT);
    return status.error_message();
  };
  EXPECT_EQ(message({messages[1]}), "PlaneChunk must be inside a frame, but it is outside");
  EXPECT_EQ(message({messages.back()}), "FrameEnd must be inside a frame, but it is outside");
  EXPECT_EQ(message({hello}), "Hello must be sent once, but it is sent again");
  EXPECT_EQ(message({v1::DenoiseRequest()}),
            "message must be Hello, FrameBegin, PlaneChunk or FrameEnd, but it is empty");
  RawStream stream(client);
  stream.write(messages[0]);
  EXPECT_EQ(stream.finish().error_message(),
            "first message of a stream must be Hello, but it is another");
  expect_alive(0);
}

TEST_F(DenoiseCall, AnswersABadFrameInTurnAndLeavesTheHistoryAsItWas) {
  Denoiser direct(config);
  RawStream stream(client);
  stream.attach();
  for (int i = 0; i < 6; ++i) {
    auto messages = RawStream::messages(test::small_frame(config, i), config);
    const bool bad = i % 2 == 1;
    if (bad) messages[2].mutable_plane_chunk()->set_offset(400);
    for (const auto& message : messages) stream.write(message);
    const v1::FrameResult result = stream.read_result();
    ASSERT_EQ(result.index(), i);
    ASSERT_EQ(result.has_error(), bad);
    if (bad) {
      EXPECT_EQ(result.error().code(), v1::FRAME_ERROR_CODE_INVALID_FRAME);
      EXPECT_EQ(result.error().violation().subject(), "offset of a chunk of plane normal");
      EXPECT_EQ(result.error().violation().value(), "400");
      continue;
    }
    PlaneSet expected;
    direct.filter(test::small_frame(config, i), expected);
    const Plane& composite = expected.at({PlaneKind::kComposite, {}});
    const std::string data = stream.read().plane_chunk().data();
    ASSERT_EQ(data.size(), wire::plane_bytes(composite, wire::PlaneFormat::kF32));
    std::string wanted(data.size(), '\0');
    wire::read_plane_bytes(composite, wire::PlaneFormat::kF32, 0, wanted.size(),
                           reinterpret_cast<std::byte*>(wanted.data()));
    EXPECT_EQ(data, wanted) << "frame " << i;
  }
  EXPECT_EQ(client.get().frames(), 3u);
  EXPECT_EQ(client.get().frame_errors(), 3u);
}

TEST_F(DenoiseCall, AnswersAFrameThatAnotherOneInterrupts) {
  RawStream stream(client);
  stream.attach();
  const auto cut_off = RawStream::messages(test::small_frame(config, 0), config);
  stream.write(cut_off[0]);
  stream.write(cut_off[1]);
  stream.write(test::small_frame(config, 1), config);
  EXPECT_EQ(stream.read_result().error().message(),
            "frame 0 must end with FrameEnd, but it is followed by another FrameBegin");
  EXPECT_FALSE(stream.read_result().has_error());
}

TEST_F(DenoiseCall, AnswersAFrameThatTheEndOfTheStreamCutsOff) {
  RawStream stream(client);
  stream.attach();
  stream.write(RawStream::messages(test::small_frame(config, 0), config)[0]);
  stream.writes_done();
  EXPECT_EQ(stream.read_result().error().message(),
            "frame 0 must end with FrameEnd, but it is followed by the end of the stream");
  EXPECT_TRUE(stream.finish().ok());
  expect_alive(0);
}

TEST_F(DenoiseCall, KeepsHistoryForAClientThatComesBack) {
  {
    RawStream stream(client);
    EXPECT_FALSE(stream.attach().resumed());
    stream.write(test::small_frame(config, 5), config);
    EXPECT_FALSE(stream.read_result().has_error());
    stream.cancel();
    stream.finish();
  }
  while (client.get().streaming()) std::this_thread::sleep_for(5ms);
  RawStream stream(client);
  const v1::Welcome welcome = stream.attach();
  EXPECT_TRUE(welcome.resumed());
  EXPECT_EQ(welcome.last_frame_index(), 5);
  stream.write(test::small_frame(config, 5), config);
  EXPECT_TRUE(stream.read_result().repeated());
  stream.write(test::small_frame(config, 4), config);
  EXPECT_EQ(stream.read_result().error().violation().subject(), "frame index");
  stream.write(test::small_frame(config, 6), config);
  EXPECT_FALSE(stream.read_result().has_error());
}

TEST_F(DenoiseCall, StopsReadingAClientThatIgnoresItsCredits) {
  // About 29 MB a frame, so that the windows of the connection hold little of one.
  config = test::small_config(1024, 800);
  ASSERT_TRUE(client.create(config).ok());
  constexpr int kFrames = 8;
  RawStream stream(client);
  stream.attach();
  std::atomic<int> written{0};
  std::thread writer([&] {
    for (int i = 0; i < kFrames; ++i) {
      if (!stream.write(test::small_frame(config, i), config)) return;
      ++written;
    }
    stream.writes_done();
  });
  // Nothing is read back: answers fill the windows, both slots stay in use, reading stops.
  int before = -1;
  for (int now = written; now != before; now = written) {
    before = now;
    std::this_thread::sleep_for(1500ms);
  }
  EXPECT_LE(before, 3) << "two slots, and what the windows hold";
  for (int i = 0; i < kFrames; ++i) {
    const v1::FrameResult result = stream.read_result();
    EXPECT_EQ(result.index(), i);
    EXPECT_FALSE(result.has_error()) << result.error().message();
  }
  writer.join();
}

TEST_F(DenoiseCall, ClosesTheStreamOfADeletedSession) {
  RawStream stream(client);
  stream.attach();
  v1::DeleteSessionRequest request;
  request.set_session_id(client.session.session_id());
  request.set_token(client.session.token());
  v1::DeleteSessionResponse response;
  grpc::ClientContext context;
  ASSERT_TRUE(client.sessions->DeleteSession(&context, request, &response).ok());
  EXPECT_EQ(stream.finish().error_code(), grpc::StatusCode::NOT_FOUND);
}

TEST_F(DenoiseCall, TellsAnOpenStreamThatTheServerDrains) {
  RawStream stream(client);
  stream.attach();
  std::thread drain([&] { server.drain(5s); });
  EXPECT_EQ(stream.read().draining().deadline_ms(), 5000u);
  EXPECT_EQ(stream.finish().error_code(), grpc::StatusCode::UNAVAILABLE);
  drain.join();
  EXPECT_EQ(client.create(config).error_code(), grpc::StatusCode::UNAVAILABLE);
}

}  // namespace
}  // namespace holdfast
