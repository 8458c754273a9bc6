#include "server/session_table.h"

#include <gtest/gtest.h>

#include "server/error.h"
#include "server/transport_memory.h"
#include "tests/service/test_frames.h"

namespace holdfast::server {
namespace {

using namespace std::chrono_literals;

SessionConfig config_of(int width, int height) {
  SessionConfig config;
  config.denoiser = test::small_config(width, height);
  return config;
}

/// The reason for which `work` is refused, and its message in `message`.
template <class F>
std::optional<Refusal> refusal_of(F&& work, std::string* message = nullptr) {
  try {
    work();
  } catch (const RefusedError& error) {
    if (message) *message = error.what();
    return error.reason();
  }
  return {};
}

TEST(SessionTable, FindsASessionByIdAndToken) {
  SessionTable table({});
  const auto session = table.create(config_of(8, 8));
  EXPECT_EQ(table.find(session->id(), session->token()), session);
  EXPECT_EQ(session->token().size(), 32u);
}

TEST(SessionTable, RefusesAnUnknownIdAndAWrongToken) {
  SessionTable table({});
  const auto session = table.create(config_of(8, 8));
  EXPECT_EQ(refusal_of([&] { table.find("nobody", session->token()); }), Refusal::kUnknownSession);
  EXPECT_EQ(refusal_of([&] { table.find(session->id(), "x" + session->token().substr(1)); }),
            Refusal::kWrongToken);
  EXPECT_EQ(refusal_of([&] { table.find(session->id(), ""); }), Refusal::kWrongToken);
}

TEST(SessionTable, TokensAndIdsOfTwoSessionsDiffer) {
  SessionTable table({});
  const auto a = table.create(config_of(8, 8)), b = table.create(config_of(8, 8));
  EXPECT_NE(a->id(), b->id());
  EXPECT_NE(a->token(), b->token());
}

TEST(SessionLife, GivesTheSessionToTheNewestStream) {
  const SessionLife::TimePoint start{};
  SessionLife life(start);
  const auto older = life.attach(), newer = life.attach();
  EXPECT_NE(older, newer);
  EXPECT_FALSE(life.detach(older, start + 1s)) << "its hold is void";
  EXPECT_TRUE(life.streaming());
  EXPECT_TRUE(life.detach(newer, start + 2s));
  EXPECT_FALSE(life.detach(newer, start + 3s)) << "a hold ends once";
  EXPECT_FALSE(life.expired(start + 11s, 10s));
  EXPECT_TRUE(life.expired(start + 12s, 10s));
}

TEST(SessionLife, ExpiresOnlyWithoutAStream) {
  const SessionLife::TimePoint start{};
  SessionLife life(start);
  EXPECT_TRUE(life.expired(start + 10s, 10s)) << "never had a stream";
  const auto hold = life.attach();
  EXPECT_FALSE(life.expired(start + 1000s, 10s));
  life.detach(hold, start + 1000s);
  life.attach();
  EXPECT_FALSE(life.expired(start + 2000s, 10s)) << "came back";
}

TEST(SessionTable, SaysWhenASessionIsTakenOverFromAnotherStream) {
  SessionTable table({});
  const auto session = table.create(config_of(8, 8));
  const auto first = table.attach(session->id(), session->token());
  EXPECT_FALSE(first.taken_over);
  const auto second = table.attach(session->id(), session->token());
  EXPECT_TRUE(second.taken_over);
  table.detach(*session, first.hold);
  EXPECT_TRUE(table.attached(*session));
  table.detach(*session, second.hold);
  EXPECT_FALSE(table.attached(*session));
  EXPECT_FALSE(table.attach(session->id(), session->token()).taken_over);
}

TEST(SessionTable, KeepsASessionWithoutAStreamForTheLingerTimeOnly) {
  SessionTable::TimePoint now{};
  SessionLimits limits;
  limits.linger = 30s;
  SessionTable table(limits, [&] { return now; });
  const auto session = table.create(config_of(8, 8));
  const auto hold = table.attach(session->id(), session->token()).hold;
  now += 100s;
  EXPECT_EQ(table.expire(), 0) << "it has a stream";
  table.detach(*session, hold);
  now += 29s;
  EXPECT_EQ(table.expire(), 0);
  now += 1s;
  EXPECT_EQ(table.expire(), 1);
  EXPECT_EQ(table.size(), 0u);
  EXPECT_EQ(table.total_bytes(), 0u);
}

TEST(SessionTable, RefusesMoreSessionsThanTheLimitUntilOneIsRemoved) {
  SessionLimits limits;
  limits.max_sessions = 1;
  SessionTable table(limits);
  const auto session = table.create(config_of(8, 8));
  std::string message;
  EXPECT_EQ(refusal_of([&] { table.create(config_of(8, 8)); }, &message), Refusal::kLimit);
  EXPECT_EQ(message, "the server has 1 sessions, the most it allows");
  table.remove(session->id(), session->token());
  EXPECT_NO_THROW(table.create(config_of(8, 8)));
}

TEST(SessionTable, RefusesASessionLargerThanTheLimitBeforeAllocatingIt) {
  SessionTable table({});
  std::string message;
  EXPECT_EQ(refusal_of([&] { table.create(config_of(16384, 16384)); }, &message), Refusal::kLimit);
  EXPECT_NE(message.find("one session may have 8192 MiB"), std::string::npos) << message;
  EXPECT_EQ(table.total_bytes(), 0u);
}

TEST(SessionMemory, IsEstimatedWithinAQuarterBeforeAnythingIsAllocated) {
  for (const std::string& recipe : recipe_names())
    for (const auto& [width, height] : {std::pair(8, 8), {37, 300}, {640, 360}, {1024, 300}}) {
      DenoiserConfig config = test::small_config(width, height);
      config.recipe = recipe;
      const SessionBytes estimate = estimated_denoiser_bytes(config);
      const Denoiser denoiser(config);
      const auto expect_near = [&](std::size_t estimated, std::size_t bytes) {
        EXPECT_GE(static_cast<double>(estimated), 0.95 * static_cast<double>(bytes))
            << recipe << width;
        EXPECT_LE(static_cast<double>(estimated), 1.25 * static_cast<double>(bytes))
            << recipe << width;
      };
      expect_near(estimate.own, denoiser.held_bytes());
      expect_near(estimate.scratch, denoiser.scratch_bytes());
    }
}

TEST(SessionTable, RefusesWhatExceedsTheMemoryOfAllSessions) {
  SessionLimits limits;
  limits.max_total_bytes = 64u << 20;
  SessionTable table(limits);
  const auto first = table.create(config_of(200, 200));
  EXPECT_GT(table.total_bytes(), 0u);
  EXPECT_EQ(refusal_of([&] { table.create(config_of(1000, 1000)); }), Refusal::kLimit);
  EXPECT_EQ(table.bytes(*first), table.session_bytes())
      << "a refused session leaves nothing behind";
  EXPECT_EQ(table.scratch_bytes(), first->denoiser_bytes().scratch);
}

TEST(SessionTable, CountsScratchOnceForEachFrameThatIsFilteredAtOnce) {
  SessionTable table({}, std::chrono::steady_clock::now, 3);
  const auto small = table.create(config_of(40, 40)), large = table.create(config_of(90, 60));
  const auto another = table.create(config_of(90, 60));
  EXPECT_EQ(table.scratch_bytes(), 3 * large->denoiser_bytes().scratch);
  EXPECT_EQ(table.session_bytes(),
            table.bytes(*small) + table.bytes(*large) + table.bytes(*another));
  EXPECT_EQ(table.total_bytes(), table.session_bytes() + table.scratch_bytes());
  table.remove(large->id(), large->token());
  EXPECT_EQ(table.scratch_bytes(), 3 * large->denoiser_bytes().scratch);
  table.remove(another->id(), another->token());
  EXPECT_EQ(table.scratch_bytes(), 3 * small->denoiser_bytes().scratch);
  table.remove(small->id(), small->token());
  EXPECT_EQ(table.total_bytes(), 0u);
}

TEST(SessionTable, RefusesASessionWhoseScratchWouldNotFit) {
  SessionTable made({});
  const auto probe = made.create(config_of(200, 200));
  SessionLimits limits;
  limits.max_total_bytes = made.session_bytes() + 4 * made.scratch_bytes();
  SessionTable table(limits, std::chrono::steady_clock::now, 4);
  EXPECT_EQ(refusal_of([&] { table.create(config_of(220, 220)); }), Refusal::kLimit)
      << "its own would fit";
  EXPECT_EQ(table.total_bytes(), 0u);
  EXPECT_NO_THROW(table.create(config_of(200, 200)));
}

// While a session changes it has both histories, and scratch is that of the larger.
TEST(SessionTable, AChangeIsAccountedBesideTheSessionUntilItIsThere) {
  SessionTable table({}, std::chrono::steady_clock::now, 2);
  const auto session = table.create(config_of(40, 40));
  const std::size_t own = table.session_bytes(), scratch = table.scratch_bytes();
  {
    const auto reserved = table.reserve(session, config_of(80, 80));
    EXPECT_GT(table.session_bytes(), 3 * own);
    EXPECT_EQ(table.bytes(*session), table.session_bytes());
    EXPECT_GT(table.scratch_bytes(), 3 * scratch);
  }
  EXPECT_EQ(table.session_bytes(), own);
  EXPECT_EQ(table.scratch_bytes(), scratch);
  auto reserved = table.reserve(session, config_of(80, 80));
  table.remove(session->id(), session->token());
  reserved.reset();
  EXPECT_EQ(table.total_bytes(), 0u) << "also where the session was removed meanwhile";
}

TEST(TransportMemory, IsThatOfPiecesAndOfCodecsWhereThereAreAny) {
  SessionConfig config;
  config.denoiser = test::small_config(8, 8);
  config.results = result_planes(config.denoiser);
  EXPECT_LT(transport_bytes(config), 300'000u) << "a small session has small pieces";
  config.denoiser.width = config.denoiser.height = 2000;
  const std::size_t exact = transport_bytes(config);
  EXPECT_EQ(exact, (5u << 20) + (1u << 18)) << "three pieces in, two out";
  config.wire = "compact";
  EXPECT_EQ(transport_bytes(config) - exact, (2u << 20) + (3u << 19)) << "two more, and zstd";
}

}  // namespace
}  // namespace holdfast::server
