// Faults of what is around a server: the path to it, its disk, its clock, its memory; and what a
// killed server costs in quality.
#include <cmath>
#include <fstream>

#include "client/scenes/builtin.h"
#include "client/scenes/renderer.h"
#include "tests/sanitizers.h"
#include "tests/service/fault_fixture.h"
#include "tests/service/frozen_relay.h"
#include "tests/service/served.h"

namespace holdfast {
namespace {

using namespace std::chrono_literals;
using test::Clock;
using test::Fault;
using test::kSlowness;
using test::seconds_since;
using test::ServerProcess;
using test::Session;
using test::tell_fault;

// Nothing tells either end: the client finds out when its keepalive has no answer, which is 10 s of
// silence and 5 s for the answer, opens another connection, and goes on with its history: within 2
// s on a machine that has time for it.
TEST_F(Fault, HalfOpenConnectionIsNoticedAndItsSessionGoesOnWithItsHistory) {
  const ServerProcess server(socket.address());
  connect().close();
  test::FrozenRelay relay(socket.address().substr(5));
  client::SessionOptions through = options();
  through.address = relay.address();
  Session session(through);
  for (int i = 0; i < 3; ++i) pass(session, i);
  const auto start = Clock::now();
  relay.freeze();
  session.submit(test::small_frame(config, 3));
  const auto output = session.receive();
  const double recovery = seconds_since(start);
  ASSERT_TRUE(output && !output->error);
  EXPECT_EQ(output->index, 3);
  EXPECT_FALSE(output->history_lost || output->history_reset);
  EXPECT_EQ(session.reconnects(), 1);
  EXPECT_LT(recovery, 15.0 + 2.0 * kSlowness);
  tell_fault("a late answer over a new connection", recovery, 0);
}

TEST_F(Fault, DiskFullForLogsChangesNothingForClients) {
  const ServerProcess server(socket.address(), {}, {"debug", "/dev/full", {}});
  Session session = connect();
  for (int i = 0; i < 10; ++i) pass(session, i);
  session.close();
  tell_fault("nothing", -1, 0);
}

// Deadlines, linger and rates go by a clock that only goes forward.
TEST_F(Fault, ClockThatJumpsByADayForthAndBackEndsNoSession) {
  if (test::kSanitized) GTEST_SKIP() << "a sanitizer has to be the first library";
  const std::string jump = (socket.directory() / "jump").string();
  const ServerProcess server(
      socket.address(), {"--linger-ms", "60000"},
      {"off", "", {{"LD_PRELOAD", HOLDFAST_JUMPING_CLOCK}, {"HOLDFAST_CLOCK_JUMP", jump}}});
  Session session = connect();
  pass(session, 0);
  test::RawClient lingering(socket.address());
  ASSERT_TRUE(lingering.create(config).ok());
  std::ofstream(jump).flush();
  pass(session, 1);
  std::this_thread::sleep_for(300ms);  // ticks look for what has expired
  EXPECT_FALSE(lingering.get().streaming()) << "still known";
  std::filesystem::remove(jump);
  pass(session, 2);
  EXPECT_FALSE(lingering.get().streaming());
  EXPECT_EQ(session.reconnects(), 0);
  tell_fault("nothing", -1, 0);
}

TEST_F(Fault, OutOfMemoryIsRefusedBeforeTheFirstFrameAndOthersGoOn) {
  const ServerProcess server(socket.address(), {"--max-total-bytes", "16777216"});
  Session first = connect();
  pass(first, 0);
  client::SessionOptions large = options();
  large.width = 1600;
  large.height = 900;
  try {
    Session second(large);
    ADD_FAILURE() << "it was admitted";
  } catch (const client::RefusedError& refusal) {
    EXPECT_NE(std::string(refusal.what()).find("16 MiB"), std::string::npos) << refusal.what();
  }
  pass(first, 1);
  tell_fault("RESOURCE_EXHAUSTED before the first frame", -1, 0);
}

/// Not owned: the frames outlive the session.
std::shared_ptr<const Frame> borrowed(const Frame& frame) {
  return {std::shared_ptr<void>(), &frame};
}

double psnr(const Plane& a, const Plane& reference) {
  double sum = 0;
  for (int c = 0; c < a.channels(); ++c)
    for (int y = 0; y < a.height(); ++y)
      for (int x = 0; x < a.width(); ++x) {
        const auto shown = [](float v) { return std::pow(std::clamp(v, 0.0f, 1.0f), 1.0f / 2.2f); };
        const double d = static_cast<double>(shown(a.channel(c).at(x, y))) -
                         static_cast<double>(shown(reference.channel(c).at(x, y)));
        sum += d * d;
      }
  return -10 * std::log10(sum / (a.channels() * a.width() * a.height()));
}

TEST_F(Fault, ServerKilledCostsLessThanADecibelOnceItsClientHasWarmedTheNextOne) {
  constexpr int kBefore = 12;
  scenes::RenderSettings settings;
  settings.width = 96;
  settings.height = 54;
  settings.reference_spp = 128;
  settings.gradients = false;
  scenes::Renderer renderer(scenes::builtin_scene("fence"), settings);
  config.width = settings.width;
  config.height = settings.height;
  config.lights = renderer.lights();
  config.planes.clear();
  std::vector<Frame> frames;
  for (int i = 0; i <= kBefore; ++i) frames.push_back(renderer.frame(i));
  for (const Plane& plane : frames.front().planes) config.planes.push_back(plane.id());

  auto server = std::make_unique<ServerProcess>(socket.address());
  Session session = connect();
  for (int i = 0; i < kBefore; ++i) {
    session.submit(borrowed(frames[static_cast<std::size_t>(i)]));
    ASSERT_FALSE(session.receive()->error);
  }
  server->signal(SIGKILL);
  server->wait();
  server = std::make_unique<ServerProcess>(socket.address());
  connect().close();  // it listens
  const auto start = Clock::now();
  session.submit(borrowed(frames.back()));
  const auto output = session.receive();
  const double recovery = seconds_since(start);
  ASSERT_TRUE(output && !output->error);
  EXPECT_TRUE(output->history_lost);
  const PlaneId composite{PlaneKind::kComposite, {}};
  const Plane& reference = renderer.reference(kBefore).at(composite);
  const double uninterrupted = psnr(test::direct(config, frames).back().at(composite), reference);
  const double warmed = psnr(output->planes.at(composite), reference);
  Denoiser fresh(config);
  PlaneSet first;
  fresh.filter(frames.back(), first);
  const double anew = psnr(first.at(composite), reference);
  EXPECT_GT(warmed, uninterrupted - 1.0);
  char saw[96];
  std::snprintf(saw, sizeof(saw), "history_lost; %.2f dB, uninterrupted %.2f, not warmed %.2f",
                warmed, uninterrupted, anew);
  tell_fault(saw, recovery, 0);
}

}  // namespace
}  // namespace holdfast
