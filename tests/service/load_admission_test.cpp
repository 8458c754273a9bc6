// Sessions that tell their rate are admitted by the time that the machine has left.
#include <chrono>
#include <cmath>
#include <thread>

#include "server/error.h"
#include "server/session_table.h"
#include "tests/core/expect_input_error.h"
#include "tests/service/served.h"

namespace holdfast {
namespace {

using namespace std::chrono_literals;
using server::SessionConfig;
using server::SessionTable;

constexpr double kRate = 10;  // frames a second

/// A session that tells its rate, and should take that share of the machine's time.
SessionConfig told(double load) {
  SessionConfig config;
  config.denoiser = test::small_config();
  config.frames_per_second = kRate;
  config.load = load;
  return config;
}

/// The quota for which `work` is refused; without a name where it is not.
template <class F>
server::Quota quota_of(F&& work) {
  try {
    work();
  } catch (const server::RefusedError& refusal) {
    EXPECT_EQ(refusal.reason(), server::Refusal::kLimit);
    return refusal.quota();
  }
  return {};
}

/// As if frames of the session had taken that long in the core.
void take_time(SessionTable& table, const server::Session& session, double ms, int frames) {
  const auto attached = table.attach(session.id(), session.token());
  const auto answer = std::make_shared<server::Answer>(std::make_shared<server::PlanePool>(1));
  answer->report.ms = ms;
  server::FrameSlot slot;
  slot.answer = answer;
  for (int i = 0; i < frames; ++i) attached.watch->sent(slot, "balanced", slot.answered);
}

TEST(LoadAdmission, RefusesWhatTheMachineHasNoTimeFor) {
  SessionTable table({});  // 0.75
  const auto first = table.create(told(0.3));
  table.create(told(0.3));
  EXPECT_DOUBLE_EQ(table.load(), 0.6);
  const server::Quota full = quota_of([&] { table.create(told(0.3)); });
  EXPECT_EQ(full.limit, "max-load");
  EXPECT_EQ(full.retry_after, server::SessionLimits{}.linger);
  EXPECT_EQ(table.size(), 2u) << "a refused session leaves nothing behind";
  EXPECT_DOUBLE_EQ(table.load(), 0.6);
  const server::Quota never = quota_of([&] { table.create(told(0.8)); });
  EXPECT_EQ(never.limit, "max-load");
  EXPECT_EQ(never.retry_after, 0ms) << "it will never fit";
  EXPECT_NO_THROW(table.create(told(0.1)));
  EXPECT_NO_THROW(table.create(told(0))) << "who tells no rate shares what is left";
  table.remove(first->id(), first->token());
  EXPECT_NO_THROW(table.create(told(0.3)));
}

TEST(LoadAdmission, WithoutALimitAdmitsAll) {
  server::SessionLimits limits;
  limits.max_load = 0;
  SessionTable table(limits);
  for (int i = 0; i < 5; ++i) EXPECT_NO_THROW(table.create(told(1)));
}

TEST(LoadAdmission, GoesByWhatFramesTookOnceThatIsKnown) {
  SessionTable table({});
  const auto session = table.create(told(0.4));
  take_time(table, *session, 10, server::SessionWatch::kJudged - 1);
  EXPECT_DOUBLE_EQ(table.load(), 0.4) << "a few frames tell nothing";
  take_time(table, *session, 10, 1);
  EXPECT_NEAR(table.load(), 1e-3 * 10 * kRate, 1e-12);
  // Others are expected to be cheaper, too: a quarter of what they were.
  for (int i = 0; i < 6; ++i) EXPECT_NO_THROW(table.create(told(0.4))) << i;
  EXPECT_NEAR(table.load(), 7 * 0.1, 1e-12);
  EXPECT_EQ(quota_of([&] { table.create(told(0.4)); }).limit, "max-load");
  take_time(table, *session, 1000, server::SessionWatch::kJudged);
  EXPECT_GT(table.load(), 1) << "what is admitted stays, but is told";
  EXPECT_EQ(quota_of([&] { table.create(told(0.001)); }).limit, "max-load");
}

TEST(LoadAdmission, WithABudgetIsThatOfTheFastestPresetWhateverFramesTake) {
  SessionTable table({});
  SessionConfig config = told(0.4);
  config.budget_ms = 5;
  const auto session = table.create(config);
  take_time(table, *session, 1, server::SessionWatch::kJudged);
  EXPECT_DOUBLE_EQ(table.load(), 0.4);
}

TEST(LoadAdmission, AChangeOfTheSessionNeedsTimeAsWell) {
  SessionTable table({});
  table.create(told(0.3));
  const auto session = table.create(told(0.3));
  EXPECT_EQ(quota_of([&] { table.reserve(session, told(0.5)); }).limit, "max-load");
  EXPECT_DOUBLE_EQ(table.load(), 0.6);
  {
    const auto reserved = table.reserve(session, told(0.4));
    EXPECT_DOUBLE_EQ(table.load(), 0.7);
    EXPECT_EQ(quota_of([&] { table.create(told(0.1)); }).limit, "max-load");
  }
  EXPECT_DOUBLE_EQ(table.load(), 0.6) << "the session is still what it was";
}

TEST(LoadAdmission, ARateThatWasToldIsKept) {
  const server::SessionRates::TimePoint start{};
  server::SessionRates rates({}, kRate, start);
  auto now = start;
  int passed = 0;
  for (; now < start + 20s; now += 1ms)
    if (rates.admit_frame(now) == 0ms) ++passed;
  EXPECT_LE(passed, 20 * kRate * 1.05 + 9) << "those that warm a new server come at once";
  EXPECT_GE(passed, 20 * kRate);
  server::SessionLimits strict;
  strict.max_frames_per_second = 2;
  server::SessionRates limited(strict, kRate, start);
  for (passed = 0, now = start; now < start + 20s; now += 1ms)
    if (limited.admit_frame(now) == 0ms) ++passed;
  EXPECT_LE(passed, 20 * 2 + 9) << "the server's limit is the stricter one";
}

TEST(LoadAdmission, IsRefusedOverTheWireByTheMeasuredCostOfThePreset) {
  server::ServerConfig config = test::server_config(1);
  config.limits.max_load = 0.5;
  config.calibrate = true;  // else within the time that CreateSession has
  const server::Server server(config);
  const DenoiserConfig frames = test::small_config();
  client::SessionOptions options = test::session_options(server, frames);
  options.frames_per_second = 1;
  client::Session session(options);
  session.submit(test::small_frame(frames, 0));
  EXPECT_FALSE(session.receive()->error);
  options.frames_per_second = 1e7;
  try {
    client::Session too_much(options);
    ADD_FAILURE() << "ten million frames a second were admitted";
  } catch (const client::RefusedError& refusal) {
    EXPECT_NE(std::string(refusal.what()).find("the server allows 50 %"), std::string::npos)
        << refusal.what();
  }
  for (const double wrong : {-1.0, std::nan(""), HUGE_VAL}) {
    options.frames_per_second = wrong;
    test::expect_input_error([&] { client::Session bad(options); }, "frames per second",
                             "must be finite and at least 0", std::to_string(wrong));
  }
  options.frames_per_second = 1;
  options.preset = "reference";
  test::expect_input_error([&] { client::Session unknown(options); }, "frames per second",
                           "must be 0 with preset reference", "1");
}

}  // namespace
}  // namespace holdfast
