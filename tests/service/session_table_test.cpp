#include "server/session_table.h"

#include <gtest/gtest.h>

#include "server/error.h"
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

TEST(SessionTable, HoldsOneStreamForEachSession) {
  SessionTable table({});
  const auto session = table.create(config_of(8, 8));
  table.attach(session->id(), session->token());
  EXPECT_EQ(refusal_of([&] { table.attach(session->id(), session->token()); }), Refusal::kBusy);
  table.detach(*session);
  EXPECT_EQ(table.attach(session->id(), session->token()), session);
}

TEST(SessionTable, KeepsASessionWithoutAStreamForTheLingerTimeOnly) {
  SessionTable::TimePoint now{};
  SessionLimits limits;
  limits.linger = 30s;
  SessionTable table(limits, [&] { return now; });
  const auto session = table.create(config_of(8, 8));
  table.attach(session->id(), session->token());
  now += 100s;
  EXPECT_EQ(table.expire(), 0) << "it has a stream";
  table.detach(*session);
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

TEST(SessionTable, RefusesWhatExceedsTheMemoryOfAllSessions) {
  SessionLimits limits;
  limits.max_total_bytes = 64u << 20;
  SessionTable table(limits);
  const auto first = table.create(config_of(200, 200));
  EXPECT_GT(table.total_bytes(), 0u);
  EXPECT_EQ(refusal_of([&] { table.create(config_of(1000, 1000)); }), Refusal::kLimit);
  EXPECT_EQ(table.bytes(*first), table.total_bytes()) << "a refused session leaves nothing behind";
}

}  // namespace
}  // namespace holdfast::server
