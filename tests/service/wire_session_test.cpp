// Wire profiles end to end: a server, the client library, rendered frames with all their planes.
#include <cmath>

#include "proto/wire_profile.h"
#include "tests/service/raw_client.h"
#include "tests/service/rendered.h"
#include "tests/service/served.h"
#include "tests/service/server_process.h"

namespace holdfast {
namespace {

using test::RawClient;
using test::RawStream;
using test::Rendered;

/// PSNR of all frames of a layer, dB, on x/(1+x) of radiance, as results are judged.
double psnr(const std::vector<PlaneSet>& a, const std::vector<PlaneSet>& b, PlaneId id) {
  double sum = 0, count = 0;
  const auto judged = [](float v) {
    const double positive = std::max(0.0, static_cast<double>(v));
    return positive / (1 + positive);
  };
  for (std::size_t i = 0; i < a.size(); ++i)
    for (int c = 0; c < a[i].at(id).channels(); ++c)
      for (int y = 0; y < a[i].at(id).height(); ++y)
        for (int x = 0; x < a[i].at(id).width(); ++x, ++count) {
          const double d =
              judged(a[i].at(id).channel(c).at(x, y)) - judged(b[i].at(id).channel(c).at(x, y));
          sum += d * d;
        }
  return -10 * std::log10(sum / count);
}

class WireSession : public ::testing::Test {
 protected:
  const server::Server server{test::server_config(2)};
  const Rendered room{"room", "reliable", 1};
};

TEST_F(WireSession, ExactIsTheDefaultAndGivesTheBitsOfTheCore) {
  const auto expected = test::direct(room.config, room.frames);
  test::expect_same(test::served(server, room.config, room.frames, "exact"), expected);
  test::expect_same(test::served(server, room.config, room.frames, ""), expected);
}

TEST_F(WireSession, ResultsOfTheOtherProfilesAreCloseToExact) {
  const auto exact = test::direct(room.config, room.frames);
  const PlaneId composite{PlaneKind::kComposite, {}};
  const auto balanced = test::served(server, room.config, room.frames, "balanced");
  const auto compact = test::served(server, room.config, room.frames, "compact");
  for (const Plane& plane : exact.front()) {
    RecordProperty("balanced_" + plane_name(plane.id()),
                   std::to_string(psnr(balanced, exact, plane.id())));
    RecordProperty("compact_" + plane_name(plane.id()),
                   std::to_string(psnr(compact, exact, plane.id())));
    EXPECT_GT(psnr(balanced, exact, plane.id()), 50) << plane_name(plane.id());
    EXPECT_GT(psnr(compact, exact, plane.id()), 40) << plane_name(plane.id());
  }
  EXPECT_GT(psnr(compact, exact, composite), 45);
}

TEST_F(WireSession, TrafficIsWhatCrossesTheWire) {
  std::vector<double> sent, received;
  for (const std::string& wire : wire::profile_names()) {
    client::SessionOptions options = test::session_options(server, room.config);
    options.wire = wire;
    client::Session session(options);
    session.submit(std::shared_ptr<const Frame>(std::shared_ptr<void>(), &room.frames[0]));
    const auto output = session.receive();
    ASSERT_TRUE(output && !output->error);
    sent.push_back(static_cast<double>(session.traffic().sent));
    received.push_back(static_cast<double>(session.traffic().received));
    session.close();
  }
  std::size_t full = 0;
  for (const Plane& plane : room.frames[0].planes)
    full += wire::plane_bytes(plane, wire::full_format(plane.id().kind));
  EXPECT_EQ(sent[0], static_cast<double>(full));
  EXPECT_LT(sent[1], 0.6 * sent[0]);
  EXPECT_LT(sent[2], sent[1]);
  EXPECT_LT(received[1], 0.6 * received[0]);
  EXPECT_LT(received[2], received[1]);
}

TEST_F(WireSession, UnknownProfilesAreRefusedByNameByLibraryAndServer) {
  client::SessionOptions options = test::session_options(server, room.config);
  options.wire = "tight";
  try {
    client::Session session(options);
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "wire must be one of exact, balanced, compact, but it is \"tight\"");
  }
  RawClient client(server.address());
  v1::CreateSessionRequest request;
  client::write_create_request(options, request);
  grpc::ClientContext context;
  v1::CreateSessionResponse response;
  const grpc::Status status = client.sessions->CreateSession(&context, request, &response);
  EXPECT_EQ(status.error_code(), grpc::StatusCode::INVALID_ARGUMENT);
  EXPECT_NE(status.error_message().find("wire must be one of exact, balanced, compact"),
            std::string::npos);
}

/// Repaired values by plane under a profile.
std::map<std::string, std::uint64_t> repairs(const server::Server& server,
                                             const DenoiserConfig& config, const Frame& frame,
                                             const std::string& wire) {
  client::SessionOptions options = test::session_options(server, config);
  options.wire = wire;
  client::Session session(options);
  session.submit(std::shared_ptr<const Frame>(std::shared_ptr<void>(), &frame));
  const auto output = session.receive();
  EXPECT_TRUE(output && !output->error);
  std::map<std::string, std::uint64_t> counts;
  for (const auto& repair : output->repaired) counts[repair.plane] = repair.values;
  EXPECT_EQ(output->non_finite_out, 0u);
  return counts;
}

TEST_F(WireSession, CountsTheSameRepairsUnderEveryProfile) {
  Rendered rendered("room", "reliable", 1, 1);
  Frame& frame = rendered.frames[0];
  const auto poison = [&](PlaneId id, int x, float value) {
    for (int c = 0; c < frame.planes.at(id).channels(); ++c)
      frame.planes.find(id)->channel(c).at(x, 20) = value;
  };
  poison({PlaneKind::kDepth, {}}, 3, NAN);
  poison({PlaneKind::kNormal, {}}, 10, NAN);
  poison({PlaneKind::kNormal, {}}, 11, 0.0f);
  poison({PlaneKind::kNormal, {}}, 12, INFINITY);
  poison(PlaneId::of_light(PlaneKind::kVisibility, 0), 30, NAN);
  poison(PlaneId::of_light(PlaneKind::kVisibility, 0), 31, -1.0f);
  poison(PlaneId::of_light(PlaneKind::kVisibility, 0), 32, 1e30f);
  poison({PlaneKind::kIndirect, {}}, 40, NAN);
  poison({PlaneKind::kIndirect, {}}, 41, -2.0f);
  poison({PlaneKind::kIndirect, {}}, 42, INFINITY);
  poison({PlaneKind::kGlossy, {}}, 43, 1e20f);
  const auto exact = repairs(server, room.config, frame, "exact");
  EXPECT_GE(exact.size(), 5u);
  EXPECT_EQ(repairs(server, room.config, frame, "balanced"), exact);
  EXPECT_EQ(repairs(server, room.config, frame, "compact"), exact);
}

TEST_F(WireSession, PlanesOfSeveralChunksArriveWhole) {
  const DenoiserConfig config = test::small_config(640, 480);
  std::vector<Frame> frames;
  for (int i = 0; i < 4; ++i) frames.push_back(test::small_frame(config, i));
  const auto exact = test::direct(config, frames);
  for (const char* wire : {"balanced", "compact"}) {
    const auto results = test::served(server, config, frames, wire);
    ASSERT_EQ(results.size(), exact.size());
    for (std::size_t i = 0; i < exact.size(); ++i)
      for (const Plane& plane : exact[i])
        for (int c = 0; c < plane.channels(); ++c)
          for (int y = 0; y < plane.height(); ++y)
            for (int x = 0; x < plane.width(); ++x)
              ASSERT_NEAR(results[i].at(plane.id()).channel(c).at(x, y), plane.channel(c).at(x, y),
                          0.006f)
                  << wire << " " << plane_name(plane.id()) << " frame " << i;
  }
}

TEST_F(WireSession, SessionsThatEndInTheMiddleOfAFrameLeaveOthersAlone) {
  const DenoiserConfig config = test::small_config(640, 480);
  const auto frame = std::make_shared<const Frame>(test::small_frame(config, 0));
  client::SessionOptions options = test::session_options(server, config);
  options.wire = "compact";
  client::Session other(options);
  for (int i = 0; i < 5; ++i) {
    client::Session session(options);
    session.submit(frame);
    if (i % 2) session.try_submit(std::make_shared<const Frame>(test::small_frame(config, 1)));
  }
  other.submit(frame);
  const auto output = other.receive();
  ASSERT_TRUE(output && !output->error);
  other.close();
}

TEST_F(WireSession, AnotherServerIsWarmedWithCodedFrames) {
  const DenoiserConfig config = test::small_config();
  const test::SocketAddress socket;
  auto process = std::make_unique<test::ServerProcess>(socket.address());
  client::SessionOptions options = test::session_options(server, config);
  options.address = socket.address();
  options.wire = "compact";
  client::Session session = test::connected(options);
  const auto pass = [&](int index) {
    session.submit(std::make_shared<const Frame>(test::small_frame(config, index)));
    auto output = session.receive();
    EXPECT_TRUE(output && !output->error);
    return output;
  };
  for (int i = 0; i < 4; ++i) EXPECT_EQ(pass(i)->index, i);
  process->signal(SIGKILL);
  process->wait();
  process = std::make_unique<test::ServerProcess>(socket.address());
  const auto output = pass(4);
  EXPECT_TRUE(output->history_lost);
  EXPECT_FALSE(output->history_reset) << "it was warmed";
  session.close();
}

TEST_F(WireSession, CorruptDataFailsItsFrameAloneAndHistoryGoesOn) {
  RawClient client(server.address());
  const DenoiserConfig config = test::small_config();
  ASSERT_TRUE(client.create(config).ok());
  RawStream stream(client);
  stream.attach();
  const auto send = [&](int index, bool corrupt) {
    auto messages = RawStream::messages(test::small_frame(config, index), config, "compact");
    if (corrupt) messages[2].mutable_plane_chunk()->mutable_data()->assign(50, 'x');
    for (const auto& message : messages) stream.write(message);
    return stream.read_result();
  };
  ASSERT_FALSE(send(0, false).has_error());
  const v1::FrameResult bad = send(1, true);
  EXPECT_EQ(bad.error().code(), v1::FRAME_ERROR_CODE_INVALID_FRAME);
  EXPECT_EQ(bad.error().violation().subject(), "data of a chunk of plane normal");
  EXPECT_EQ(bad.error().violation().value(), "corrupt");
  const v1::FrameResult next = send(1, false);
  EXPECT_FALSE(next.has_error());
  EXPECT_FALSE(next.history_reset()) << "history is as before the bad frame";
}

}  // namespace
}  // namespace holdfast
