#include <thread>

#include "server/convert.h"
#include "tests/service/served.h"

namespace holdfast {
namespace {

using client::Session;
using client::SessionOptions;
using test::direct;
using test::expect_same;
using test::served;
using test::server_config;
using test::session_options;

std::vector<Frame> small_frames(const DenoiserConfig& config, int count, std::uint32_t seed) {
  std::vector<Frame> frames;
  for (int i = 0; i < count; ++i) frames.push_back(test::small_frame(config, i, seed));
  return frames;
}

/// A session that leaves the unshadowed light to the server.
DenoiserConfig shaded_config() {
  DenoiserConfig config = test::small_config();
  config.lights[0].radiance = {1.0, 2.0, 3.0};
  config.planes[3] = {PlaneKind::kAlbedo, {}};
  return config;
}

class Service : public ::testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Threads, Service, ::testing::Values(1, 2));

TEST_P(Service, GivesTheBitsOfTheCoreCalledDirectly) {
  const server::Server server(server_config(GetParam()));
  const DenoiserConfig config = test::small_config();
  const std::vector<Frame> frames = small_frames(config, 6, 1);
  expect_same(served(server, config, frames), direct(config, frames));
}

TEST_P(Service, KnowsWhatALightEmitsWhereItsUnshadowedPlaneIsNotSent) {
  const server::Server server(server_config(GetParam()));
  const DenoiserConfig config = shaded_config();
  const std::vector<Frame> frames = small_frames(config, 2, 1);
  expect_same(served(server, config, frames), direct(config, frames));
  DenoiserConfig dark = config;
  dark.lights[0].radiance = glm::dvec3(0);
  EXPECT_FALSE(test::same_bits(direct(config, frames)[0], direct(dark, frames)[0]));
}

TEST(SessionConfig, RefusesARadianceThatHasNotThreeNumbers) {
  v1::CreateSessionRequest request;
  request.set_width_px(4);
  request.set_height_px(4);
  v1::Light& light = *request.add_lights();
  light.set_shape(v1::LIGHT_SHAPE_POINT);
  for (int count = 1; count <= 4; ++count) {
    light.add_radiance(1.0);
    if (count == 3)
      EXPECT_NO_THROW(server::session_config_from(request));
    else
      EXPECT_THROW(server::session_config_from(request), InputError) << count;
  }
}

TEST_P(Service, CarriesPlanesLargerThanAChunk) {
  const server::Server server(server_config(GetParam()));
  const DenoiserConfig config = test::small_config(641, 480);  // 1.2 MB a channel
  const std::vector<Frame> frames = small_frames(config, 2, 1);
  expect_same(served(server, config, frames), direct(config, frames));
}

TEST_P(Service, KeepsTwoSessionsThatStreamAtOnceApart) {
  const server::Server server(server_config(GetParam()));
  const DenoiserConfig a = test::small_config(), b = test::small_config(64, 48);
  const std::vector<Frame> frames_a = small_frames(a, 12, 1), frames_b = small_frames(b, 12, 2);
  std::vector<PlaneSet> results_a;
  std::thread other([&] { results_a = served(server, a, frames_a); });
  const std::vector<PlaneSet> results_b = served(server, b, frames_b);
  other.join();
  expect_same(results_a, direct(a, frames_a));
  expect_same(results_b, direct(b, frames_b));
}

TEST(ClientSession, ReportsTimesAndTrafficOfAFrame) {
  const server::Server server(server_config(1));
  const DenoiserConfig config = test::small_config(10, 10);
  Session session(session_options(server, config));
  session.submit(test::small_frame(config, 7));
  const auto output = session.receive();
  ASSERT_TRUE(output);
  EXPECT_EQ(output->index, 7);
  EXPECT_EQ(output->preset, config.preset);
  EXPECT_GT(output->timing.total, 0.0);
  EXPECT_GE(output->timing.total, output->timing.core);
  EXPECT_EQ(session.traffic().sent, 10u * 10 * 4 * (1 + 3 + 1 + 3 + 1));
  EXPECT_EQ(session.traffic().received, 10u * 10 * 4 * (3 + 1));
}

TEST(ClientSession, SendsBackOnlyTheResultsAskedFor) {
  const server::Server server(server_config(1));
  const DenoiserConfig config = test::small_config();
  SessionOptions options = session_options(server, config);
  options.results = {PlaneId::of_light(PlaneKind::kVisibility, 0)};
  Session session(options);
  session.submit(test::small_frame(config, 0));
  const auto output = session.receive();
  ASSERT_TRUE(output);
  EXPECT_EQ(output->planes.size(), 1u);
  EXPECT_TRUE(output->planes.find(options.results[0]));
}

TEST(ClientSession, SubmitsNoMoreThanItsCreditsUntilAnAnswerComes) {
  const server::Server server(server_config(1, 2));
  const DenoiserConfig config = test::small_config(400, 300);
  Session session(session_options(server, config));
  EXPECT_EQ(session.credits(), 2);
  std::vector<std::shared_ptr<const Frame>> frames;  // made first: making them takes longer
  for (int i = 0; i < 8; ++i)
    frames.push_back(std::make_shared<const Frame>(test::small_frame(config, i)));
  int refused = 0;
  for (std::size_t i = 0; i < frames.size();) {
    ASSERT_LE(session.in_flight(), 2);
    if (session.try_submit(frames[i])) {
      ++i;
    } else {
      ++refused;
      ASSERT_TRUE(session.receive());
    }
  }
  EXPECT_GT(refused, 0);
}

TEST(ClientSession, RefusesPlanesThatAreNotTheSessionsAndGoesOn) {
  const server::Server server(server_config(1));
  const DenoiserConfig config = test::small_config();
  Session session(session_options(server, config));
  const auto message = [&](auto damage) -> std::string {
    Frame frame = test::small_frame(config, 0);
    damage(frame.planes);
    try {
      session.submit(std::move(frame));
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  };
  const PlaneId depth{PlaneKind::kDepth, {}}, albedo{PlaneKind::kAlbedo, {}};
  EXPECT_EQ(message([&](PlaneSet& p) { p.add(depth, 37, 20); }),
            "plane depth must be 37x21, but it is 37x20");
  EXPECT_EQ(message([&](PlaneSet& p) { p.remove(depth); }),
            "plane depth must be present, but it is missing");
  EXPECT_EQ(message([&](PlaneSet& p) { p.add(albedo, 37, 21); }),
            "plane albedo must be a plane of the session, but it is not declared");
  session.submit(test::small_frame(config, 0));
  const auto output = session.receive();
  ASSERT_TRUE(output);
  EXPECT_FALSE(output->error);
}

TEST(ClientSession, GetsAnErrorForAnIndexThatGoesBackAndKeepsItsHistory) {
  const server::Server server(server_config(1, 1));  // one answer is remembered
  const DenoiserConfig config = test::small_config();
  Session session(session_options(server, config));
  std::vector<PlaneSet> results;
  for (const int index : {0, 1, 0, 0, 2}) {
    session.submit(test::small_frame(config, index));
    auto output = session.receive();
    ASSERT_TRUE(output);
    if (static_cast<int>(results.size()) == index) {
      ASSERT_FALSE(output->error);
      results.push_back(std::move(output->planes));
    } else {
      ASSERT_TRUE(output->error && output->error->input);
      EXPECT_EQ(output->error->input->subject(), "frame index");
      EXPECT_EQ(output->error->input->value(), std::to_string(index));
    }
  }
  expect_same(results, direct(config, small_frames(config, 3, 1)));
}

TEST(ClientSession, NamesTheOptionThatTheServerRefuses) {
  const server::Server server(server_config(1));
  const auto message = [&](auto damage) -> std::string {
    SessionOptions options = session_options(server, test::small_config());
    damage(options);
    try {
      Session session(options);
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_EQ(message([](SessionOptions& o) { o.width = 0; }),
            "width must be in 1..16384, but it is 0");
  EXPECT_EQ(message([](SessionOptions& o) { o.wire = "zip"; }),
            "wire must be one of exact, balanced, compact, but it is \"zip\"");
  EXPECT_NE(message([](SessionOptions& o) { o.recipe = "magic"; }).find("spatial, traditional"),
            std::string::npos);
  EXPECT_NE(message([](SessionOptions& o) { o.preset = "x"; }).find("must be one of"),
            std::string::npos);
  EXPECT_EQ(message([](SessionOptions& o) { o.planes.push_back(o.planes[0]); }),
            "plane depth must be declared once, but it is declared twice");
  EXPECT_NE(message([](SessionOptions& o) {
              o.results = {{PlaneKind::kDepth, {}}};
            }).find("result plane must be one of composite"),
            std::string::npos);
}

TEST(ClientSession, SaysThatAServerIsNotThere) {
  SessionOptions options;
  options.address = "127.0.0.1:1";
  try {
    Session session(options);
    FAIL();
  } catch (const client::ConnectionError& error) {
    EXPECT_EQ(std::string(error.what()).find("server 127.0.0.1:1 cannot be reached"), 0u);
  }
}

TEST(ClientSession, SaysThatTheServerIsFull) {
  server::ServerConfig config = server_config(1);
  config.limits.max_sessions = 1;
  const server::Server server(config);
  const SessionOptions options = session_options(server, test::small_config());
  {
    const Session first(options);
    EXPECT_THROW(Session second(options), client::RefusedError);
  }
  EXPECT_NO_THROW(Session third(options)) << "the first was deleted by its destructor";
}

TEST(ClientSession, GetsItsFramesInFlightWhenTheServerDrains) {
  server::Server server(server_config(1));
  const DenoiserConfig config = test::small_config(400, 300);
  SessionOptions options = session_options(server, config);
  options.reconnect_timeout = std::chrono::milliseconds(0);
  Session session(options);
  for (int i = 0; i < session.credits(); ++i) session.submit(test::small_frame(config, i));
  ASSERT_TRUE(session.receive());  // all of them have reached the server, or are about to
  std::thread drain([&] { server.drain(std::chrono::seconds(10)); });
  EXPECT_THROW(
      {
        for (int i = session.credits(); i < 1000; ++i) {
          session.submit(test::small_frame(config, i));
          session.receive();
        }
      },
      client::ConnectionError);
  drain.join();
}

TEST(ClientSession, GivesUpALostConnectionAfterItsTimeWithoutAHang) {
  auto server = std::make_unique<server::Server>(server_config(1));
  const DenoiserConfig config = test::small_config();
  SessionOptions options = session_options(*server, config);
  options.reconnect_timeout = std::chrono::milliseconds(100);
  Session session(options);
  session.submit(test::small_frame(config, 0));
  ASSERT_TRUE(session.receive());
  server.reset();
  EXPECT_THROW(
      {
        session.submit(test::small_frame(config, 1));
        session.receive();
      },
      client::ConnectionError);
}

}  // namespace
}  // namespace holdfast
