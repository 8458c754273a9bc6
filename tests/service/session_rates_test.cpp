// Limits on how fast a session may send: the bucket by itself, and what a client sees of it.
#include "server/session_rates.h"

#include <fstream>
#include <random>

#include "server/error.h"
#include "server/session_table.h"
#include "tests/service/raw_client.h"
#include "tests/service/served.h"
#include "tests/service/server_process.h"

namespace holdfast {
namespace {

using namespace std::chrono_literals;
using server::TokenBucket;

constexpr TokenBucket::TimePoint kStart{};

double seconds(TokenBucket::Duration time) { return std::chrono::duration<double>(time).count(); }

TEST(TokenBucket, LetsNoMoreThanBurstAndRatePassInAnySpanOfTime) {
  std::mt19937 random(1);
  const auto uniform = [&](double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(random);
  };
  for (int run = 0; run < 50; ++run) {
    const double rate = uniform(0.5, 200), burst = uniform(1, 50);
    TokenBucket bucket(rate, burst, kStart);
    std::vector<double> passed;  // seconds at which one unit passed
    TokenBucket::TimePoint now = kStart;
    for (int i = 0; i < 400; ++i) {
      now += std::chrono::nanoseconds(static_cast<long>(uniform(0, 2e9 / rate)));
      if (bucket.wait(1, now) > 0ns) continue;
      bucket.take(1, now);
      passed.push_back(seconds(now - kStart));
    }
    for (std::size_t a = 0; a < passed.size(); ++a)
      for (std::size_t b = a; b < passed.size(); ++b)
        ASSERT_LE(static_cast<double>(b - a + 1), burst + rate * (passed[b] - passed[a]) + 1e-6)
            << "rate " << rate << ", burst " << burst;
  }
}

TEST(TokenBucket, GivesTheWholeRateToOneWhoAlwaysWaits) {
  for (const double rate : {0.7, 30.0, 1000.0}) {
    TokenBucket bucket(rate, 1, kStart);
    TokenBucket::TimePoint now = kStart;
    for (int i = 0; i < 1000; ++i) {
      now += bucket.wait(1, now);
      EXPECT_LE(bucket.wait(1, now), 2ns) << "the time that it named is enough";
      bucket.take(1, now);
    }
    EXPECT_NEAR(seconds(now - kStart) * rate, 999, 0.01) << "rate " << rate;
  }
}

TEST(TokenBucket, MakesWhatWasTakenTooMuchWaitedFor) {
  TokenBucket bucket(100, 10, kStart);
  bucket.take(60, kStart);  // 50 are owed
  EXPECT_EQ(bucket.wait(0, kStart), 500ms);
  EXPECT_EQ(bucket.wait(0, kStart + 200ms), 300ms);
  EXPECT_EQ(bucket.wait(0, kStart + 500ms), 0ms);
}

TEST(TokenBucket, SavesUpNoMoreThanItsBurstAndNeedsNoMore) {
  TokenBucket bucket(100, 10, kStart);
  bucket.take(10, kStart + 24h);
  EXPECT_EQ(bucket.wait(1, kStart + 24h), 10ms);
  EXPECT_EQ(bucket.wait(1000, kStart + 24h), 100ms) << "more than the burst is never there";
  EXPECT_EQ(bucket.wait(1, kStart), 10ms) << "a clock that goes back gives nothing";
}

TEST(TokenBucket, WithoutARateNeverWaits) {
  TokenBucket bucket(0, 0, kStart);
  for (int i = 0; i < 1000; ++i) bucket.take(1e9, kStart);
  EXPECT_EQ(bucket.wait(1, kStart), 0ms);
}

TEST(SessionTable, CountsTheSessionsOfEachBearerToken) {
  server::SessionLimits limits;
  limits.max_sessions_per_token = 2;
  server::SessionTable table(limits);
  server::SessionConfig config;
  config.denoiser = test::small_config();
  const auto first = table.create(config, "one");
  table.create(config, "one");
  try {
    table.create(config, "one");
    ADD_FAILURE() << "a third was admitted";
  } catch (const server::RefusedError& refusal) {
    EXPECT_EQ(refusal.quota().limit, "max-sessions-per-token");
    EXPECT_EQ(refusal.quota().retry_after, limits.linger);
    EXPECT_EQ(std::string(refusal.what()).find("one session"), std::string::npos);
  }
  EXPECT_NO_THROW(table.create(config, "another"));
  for (int i = 0; i < 3; ++i) EXPECT_NO_THROW(table.create(config)) << "no token is asked for";
  table.remove(first->id(), first->token());
  EXPECT_NO_THROW(table.create(config, "one"));
}

TEST(BearerToken, WithItsNumberOfSessionsIsRefusedOverTheWireWithTheNameOfTheLimit) {
  const test::SocketAddress place;
  server::ServerConfig config = test::server_config(1);
  config.token_file = (place.directory() / "tokens").string();
  config.limits.max_sessions_per_token = 1;
  std::ofstream(config.token_file) << "one\ntwo\n";
  const server::Server server(config);
  test::RawClient client(server.address());
  v1::CreateSessionRequest request;
  client::write_create_request(test::session_options(server, test::small_config()), request);
  const auto quota_of = [&](const std::string& token) {
    grpc::ClientContext context;
    context.AddMetadata("authorization", "Bearer " + token);
    v1::CreateSessionResponse response;
    const grpc::Status status = client.sessions->CreateSession(&context, request, &response);
    if (status.ok()) return std::string("none");
    EXPECT_EQ(status.error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED);
    const auto& trailing = context.GetServerTrailingMetadata();
    EXPECT_EQ(trailing.count("holdfast-retry-after-ms"), 1u);
    const auto found = trailing.find("holdfast-quota");
    return found == trailing.end() ? "unnamed"
                                   : std::string(found->second.data(), found->second.size());
  };
  EXPECT_EQ(quota_of("one"), "none");
  EXPECT_EQ(quota_of("one"), "max-sessions-per-token");
  EXPECT_EQ(quota_of("two"), "none");
}

class Rates : public ::testing::Test {
 protected:
  /// Seconds for `count` frames sent as fast as credits allow, all of which are answered.
  double seconds_for(int count) {
    const server::Server server(config);
    client::Session session(test::session_options(server, frames));
    const auto start = std::chrono::steady_clock::now();
    std::thread sender([&] {
      for (int i = 0; i < count; ++i) session.submit(test::small_frame(frames, i));
      session.finish();
    });
    int next = 0;
    while (const auto output = session.receive()) {
      EXPECT_FALSE(output->error) << output->error->message;
      EXPECT_EQ(output->index, next++);
    }
    sender.join();
    EXPECT_EQ(next, count) << "none is lost";
    EXPECT_EQ(session.reconnects(), 0);
    return seconds(std::chrono::steady_clock::now() - start);
  }
  server::ServerConfig config = test::server_config(1);
  DenoiserConfig frames = test::small_config();
};

TEST_F(Rates, HoldUpAClientThatSendsTooManyFramesAndLoseNone) {
  config.limits.max_frames_per_second = 20;  // a burst of 5
  EXPECT_GE(seconds_for(15), (15 - 5) / 20.0 - 0.01);
}

TEST_F(Rates, HoldUpAClientThatSendsTooManyBytesAndLoseNone) {
  frames = test::small_config(160, 100);  // 9 words a pixel: 0.58 MB
  config.limits.max_bytes_per_second = 4'000'000;
  // The burst, and the last frame, whose debt nobody waits for.
  EXPECT_GE(seconds_for(6), (5 * 0.576e6 - 1e6) / 4e6 - 0.01);
}

TEST_F(Rates, DoNotCountTheWaitAgainstTheFrame) {
  frames = test::small_config(160, 100);
  config.limits.max_bytes_per_second = 250'000;  // 2.3 s a frame
  config.frame_timeout = 1000ms;
  EXPECT_GE(seconds_for(2), 3.5);
}

TEST_F(Rates, StayWithTheSessionWhenItsClientConnectsAgain) {
  config.limits.max_frames_per_second = 4;  // a burst of 1
  const server::Server server(config);
  test::RawClient client(server.address());
  ASSERT_TRUE(client.create(frames).ok());
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < 3; ++i) {
    test::RawStream stream(client);
    stream.attach();
    stream.write(test::small_frame(frames, i), frames);
    EXPECT_FALSE(stream.read_result().has_error());
  }
  EXPECT_GE(seconds(std::chrono::steady_clock::now() - start), 2 / 4.0 - 0.01);
}

}  // namespace
}  // namespace holdfast
