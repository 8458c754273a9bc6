// Another size, recipe or preset in mid-session.
#include <thread>

#include "tests/service/raw_client.h"
#include "tests/service/served.h"

namespace holdfast {
namespace {

using namespace std::chrono_literals;
using client::FrameOutput;
using client::Session;
using test::RawClient;
using test::RawStream;

class ChangedSession : public ::testing::Test {
 protected:
  void start(const std::string& listen = "127.0.0.1:0") {
    config.listen = listen;
    server = std::make_unique<server::Server>(config);
  }
  Session connect() const { return Session(test::session_options(*server, small)); }
  static FrameOutput pass(Session& session, const DenoiserConfig& of, int index) {
    session.submit(test::small_frame(of, index));
    auto output = session.receive();
    EXPECT_TRUE(output && output->index == index);
    return std::move(*output);
  }
  /// What the core makes of `first` frames of `before`, then `then` of `after`.
  static PlaneSet direct(const DenoiserConfig& before, int first, const DenoiserConfig& after,
                         int then) {
    PlaneSet results;
    Denoiser one(before);
    for (int i = 0; i < first; ++i) one.filter(test::small_frame(before, i), results);
    Denoiser other(after, one);
    for (int i = first; i < first + then; ++i) other.filter(test::small_frame(after, i), results);
    return results;
  }
  static v1::DenoiseRequest with_size(v1::DenoiseRequest begin, const DenoiserConfig& of) {
    v1::SessionChange& change = *begin.mutable_frame_begin()->mutable_change();
    change.set_width_px(static_cast<std::uint32_t>(of.width));
    change.set_height_px(static_cast<std::uint32_t>(of.height));
    return begin;
  }

  server::ServerConfig config = test::server_config(1);
  const DenoiserConfig small = test::small_config(), large = test::small_config(64, 48);
  std::unique_ptr<server::Server> server;
};

TEST_F(ChangedSession, OfAnotherSizeGoesOnWithItsHistoryAsTheCoreDoes) {
  start();
  Session session = connect();
  for (int i = 0; i < 3; ++i) pass(session, small, i);
  session.change({.width = large.width, .height = large.height, .recipe = {}, .preset = {}});
  EXPECT_FALSE(pass(session, large, 3).history_reset);
  EXPECT_TRUE(test::same_bits(pass(session, large, 4).planes, direct(small, 3, large, 2)));
  session.change({.width = small.width, .height = small.height, .recipe = {}, .preset = {}});
  const FrameOutput back = pass(session, small, 5);
  EXPECT_FALSE(back.history_reset);
  EXPECT_GT(back.mean_history_frames, 1.5);
  session.close();
}

TEST_F(ChangedSession, TakesFramesOfBothSizesInFlight) {
  start();
  Session session = connect();
  session.submit(test::small_frame(small, 0));
  session.change({.width = large.width, .height = large.height, .recipe = {}, .preset = {}});
  session.submit(test::small_frame(large, 1));
  session.submit(test::small_frame(large, 2));
  for (int i = 0; i < 3; ++i) {
    const auto output = session.receive();
    ASSERT_TRUE(output && !output->error);
    EXPECT_EQ(output->planes.begin()->width(), i == 0 ? small.width : large.width);
  }
}

TEST_F(ChangedSession, OfAnotherRecipeAndPresetGoesOnWithItsHistory) {
  start();
  Session session = connect();
  for (int i = 0; i < 3; ++i) pass(session, small, i);
  session.change({.width = 0, .height = 0, .recipe = "svgf", .preset = "fast"});
  const FrameOutput output = pass(session, small, 3);
  EXPECT_FALSE(output.error || output.history_reset);
  EXPECT_EQ(output.preset, "fast");
  DenoiserConfig after = small;
  after.recipe = "svgf";
  after.preset = "fast";
  EXPECT_TRUE(test::same_bits(output.planes, direct(small, 3, after, 1)));
}

TEST_F(ChangedSession, IsRefusedWhereMemoryLacksAndLosesNothing) {
  config.limits.max_session_bytes = 8u << 20;
  start();
  const DenoiserConfig huge = test::small_config(1000, 800);
  Session session = connect();
  for (int i = 0; i < 3; ++i) pass(session, small, i);
  session.change({.width = huge.width, .height = huge.height, .recipe = {}, .preset = {}});
  const FrameOutput refused = pass(session, huge, 3);
  ASSERT_TRUE(refused.error);
  EXPECT_TRUE(refused.error->refused);
  EXPECT_NE(refused.error->message.find("one session may have 8 MiB"), std::string::npos)
      << refused.error->message;
  session.change({.width = small.width, .height = small.height, .recipe = {}, .preset = {}});
  std::vector<Frame> frames;
  for (int i = 0; i < 4; ++i) frames.push_back(test::small_frame(small, i));
  EXPECT_TRUE(test::same_bits(pass(session, small, 3).planes, test::direct(small, frames).back()));
}

TEST_F(ChangedSession, ToAWrongNameOrSizeFailsItsFrameAndLosesNothing) {
  start();
  RawClient client(server->address());
  ASSERT_TRUE(client.create(small).ok());
  RawStream stream(client);
  stream.attach();
  stream.write(test::small_frame(small, 0), small);
  EXPECT_FALSE(stream.read_result().has_error());
  const auto subject_of = [&](auto spoil) {
    auto messages = RawStream::messages(test::small_frame(small, 1), small);
    spoil(*messages[0].mutable_frame_begin()->mutable_change());
    for (const auto& message : messages) stream.write(message);
    return stream.read_result().error().violation().subject();
  };
  EXPECT_EQ(subject_of([](v1::SessionChange& c) { c.set_recipe("none"); }), "recipe");
  EXPECT_EQ(subject_of([](v1::SessionChange& c) { c.set_preset("none"); }), "preset");
  EXPECT_EQ(subject_of([](v1::SessionChange& c) { c.set_width_px(1u << 31); }), "width");
  EXPECT_EQ(subject_of([](v1::SessionChange& c) { c.set_width_px(38); }), "plane depth");
  stream.write(with_size(RawStream::messages(test::small_frame(small, 1), small)[0], small));
  const auto messages = RawStream::messages(test::small_frame(small, 1), small);
  for (std::size_t i = 1; i < messages.size(); ++i) stream.write(messages[i]);
  const v1::FrameResult result = stream.read_result();
  EXPECT_FALSE(result.has_error()) << result.error().message();
  EXPECT_FALSE(result.history_reset());
}

TEST_F(ChangedSession, ResumesOnAnotherStreamAsItWas) {
  start();
  RawClient client(server->address());
  ASSERT_TRUE(client.create(small).ok());
  {
    RawStream stream(client);
    stream.attach();
    auto messages = RawStream::messages(test::small_frame(large, 0), large);
    messages[0] = with_size(messages[0], large);
    for (const auto& message : messages) stream.write(message);
    ASSERT_FALSE(stream.read_result().has_error());
    stream.cancel();
    stream.finish();
  }
  RawStream again(client);
  EXPECT_TRUE(again.attach().resumed());
  again.write(test::small_frame(large, 1), large);
  const v1::FrameResult result = again.read_result();
  EXPECT_FALSE(result.has_error()) << result.error().message();
  EXPECT_FALSE(result.history_reset());
}

TEST_F(ChangedSession, IsWarmedAfterTheLossOfAServerWithFramesOfBothSizes) {
  start();
  Session session = connect();
  for (int i = 0; i < 2; ++i) pass(session, small, i);
  session.change({.width = large.width, .height = large.height, .recipe = {}, .preset = {}});
  for (int i = 2; i < 4; ++i) pass(session, large, i);
  const std::string address = server->address();
  server.reset();
  start(address);
  const FrameOutput output = pass(session, large, 4);
  EXPECT_TRUE(output.history_lost);
  EXPECT_FALSE(output.history_reset);
  EXPECT_TRUE(test::same_bits(output.planes, direct(small, 2, large, 3)));
}

TEST_F(ChangedSession, HoldsForTheFrameAfterADroppedOne) {
  start();
  RawClient client(server->address());
  ASSERT_TRUE(client.create(small, v1::LATE_FRAMES_LATEST).ok());
  RawStream stream(client);
  stream.attach();
  auto messages = RawStream::messages(test::small_frame(large, 0), large);
  messages[0] = with_size(messages[0], large);
  messages[0].mutable_frame_begin()->set_deadline_ms(1e-6);  // always missed: dropped
  for (const auto& message : messages) stream.write(message);
  EXPECT_TRUE(stream.read_result().dropped());
  stream.write(test::small_frame(large, 1), large);
  const v1::FrameResult result = stream.read_result();
  EXPECT_FALSE(result.has_error()) << result.error().message();
  EXPECT_EQ(result.planes(0).width_px(), static_cast<std::uint32_t>(large.width));
}

TEST_F(ChangedSession, IsAccountedAsOneThatWasMadeThatWay) {
  start();
  RawClient client(server->address()), other(server->address());
  ASSERT_TRUE(client.create(small).ok());
  ASSERT_TRUE(other.create(large).ok());
  RawStream stream(client);
  stream.attach();
  auto messages = RawStream::messages(test::small_frame(large, 0), large);
  messages[0] = with_size(messages[0], large);
  for (const auto& message : messages) stream.write(message);
  ASSERT_FALSE(stream.read_result().has_error());
  EXPECT_EQ(client.get().memory_bytes(), other.get().memory_bytes());
}

}  // namespace
}  // namespace holdfast
