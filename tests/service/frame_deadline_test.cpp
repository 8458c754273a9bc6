// Deadlines of frames, and streams that are cancelled with frames waiting.
#include <thread>

#include "server/late_frames.h"
#include "tests/service/raw_client.h"
#include "tests/service/served.h"

namespace holdfast {
namespace {

using namespace std::chrono_literals;
using server::FrameTurn;
using test::RawClient;
using test::RawStream;

constexpr FrameTurn::TimePoint kNow{std::chrono::hours(1)};

TEST(FrameTurn, IsLateAfterItsDeadlineAndNotAtIt) {
  EXPECT_FALSE(FrameTurn(kNow, {}, false, false).late);
  EXPECT_FALSE(FrameTurn(kNow, kNow, false, false).late);
  EXPECT_TRUE(FrameTurn(kNow + 1ns, kNow, false, false).late);
}

TEST(FrameTurn, DropsLateAndOvertakenFramesUnderLatestOnly) {
  for (const bool newer : {false, true}) {
    EXPECT_FALSE(FrameTurn(kNow, kNow - 1ms, false, newer).drop) << "policy ALL";
    EXPECT_TRUE(FrameTurn(kNow, kNow - 1ms, true, newer).drop);
    EXPECT_EQ(FrameTurn(kNow, kNow + 1ms, true, newer).drop, newer);
    EXPECT_EQ(FrameTurn(kNow, {}, true, newer).drop, newer);
  }
}

constexpr double kMissed = 1e-6, kKept = 3e6;  // ms: nothing is as fast, nothing as slow

/// Five frames, the third with a deadline that it misses, the others with one that they keep.
std::vector<client::FrameOutput> outputs_of(client::LateFrames policy) {
  const server::Server server(test::server_config(1));
  const DenoiserConfig config = test::small_config();
  std::vector<client::FrameOutput> outputs;
  client::SessionOptions options = test::session_options(server, config);
  options.late_frames = policy;
  options.frame_deadline_ms = kKept;
  client::Session patient(options);
  options.frame_deadline_ms = kMissed;
  client::Session hasty(options);
  for (int i = 0; i < 2; ++i)
    for (client::Session* session : {&patient, &hasty}) {
      session->submit(test::small_frame(config, i));
      outputs.push_back(*session->receive());
    }
  return outputs;
}

TEST(FrameDeadline, ThatPassesMarksTheFrameAndUnderAllItIsFilteredAllTheSame) {
  const auto outputs = outputs_of(client::LateFrames::kAll);
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    EXPECT_FALSE(outputs[i].error || outputs[i].dropped);
    EXPECT_GT(outputs[i].planes.size(), 0u);
    EXPECT_EQ(outputs[i].deadline_passed, i % 2 == 1);
  }
}

TEST(FrameDeadline, ThatPassesDropsTheFrameUnderLatest) {
  const auto outputs = outputs_of(client::LateFrames::kLatest);
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    EXPECT_FALSE(outputs[i].error);
    EXPECT_EQ(outputs[i].deadline_passed, i % 2 == 1);
    EXPECT_EQ(outputs[i].dropped, i % 2 == 1);
  }
}

TEST(FrameDeadline, OfNoNumberFailsItsFrameAlone) {
  const server::Server server(test::server_config(1));
  const DenoiserConfig config = test::small_config();
  RawClient client(server.address());
  ASSERT_TRUE(client.create(config).ok());
  RawStream stream(client);
  stream.attach();
  for (const double deadline : {-1.0, std::nan(""), HUGE_VAL}) {
    auto messages = RawStream::messages(test::small_frame(config, 0), config);
    messages[0].mutable_frame_begin()->set_deadline_ms(deadline);
    for (const auto& message : messages) stream.write(message);
    EXPECT_EQ(stream.read_result().error().violation().subject(), "deadline of frame 0");
  }
  stream.write(test::small_frame(config, 0), config);
  EXPECT_FALSE(stream.read_result().has_error());
}

// Three large frames wait in line when their stream is cancelled: what has not begun never does.
TEST(CancelledStream, LeavesItsWaitingFramesUnfiltered) {
  const server::Server server(test::server_config(1));
  const DenoiserConfig config = test::small_config(1500, 1000);
  std::uint64_t least = 3;  // the best of a few attempts: the machine may be slow to cancel
  for (int attempt = 0; attempt < 5 && least > 2; ++attempt) {
    RawClient client(server.address());
    ASSERT_TRUE(client.create(config).ok());
    {
      RawStream stream(client);
      stream.attach();
      for (int i = 0; i < 3; ++i) stream.write(test::small_frame(config, i), config);
      stream.cancel();
      stream.finish();
    }
    v1::GetSessionResponse session = client.get();
    for (; session.streaming(); session = client.get()) std::this_thread::sleep_for(5ms);
    least = std::min(least, session.frames());
  }
  EXPECT_LE(least, 2u);
}

}  // namespace
}  // namespace holdfast
