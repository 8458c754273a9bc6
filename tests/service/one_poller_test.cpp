#include "proto/one_poller.h"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <latch>
#include <memory>
#include <mutex>
#include <set>
#include <thread>
#include <vector>

#include <grpcpp/create_channel.h>
#include <grpcpp/generic/generic_stub.h>
#include <grpcpp/security/credentials.h>
#include <gtest/gtest.h>

namespace holdfast {
namespace {

using namespace std::chrono_literals;

/// Calls fail at once; channels share no pauses between attempts to connect.
std::shared_ptr<grpc::Channel> channel_to_nobody() {
  grpc::ChannelArguments arguments;
  arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
  return grpc::CreateCustomChannel("unix:/proc/self/none", grpc::InsecureChannelCredentials(),
                                   arguments);
}

struct Call {
  grpc::ClientContext context;
  grpc::ByteBuffer request, response;
};

/// How many threads run the reactions to many calls at once, all of which fail.
std::size_t reacting_threads() {
  constexpr int kCalls = 100;
  grpc::GenericStub stub(channel_to_nobody());
  const grpc::Slice nothing("", 1);
  std::vector<std::unique_ptr<Call>> calls;
  std::set<std::thread::id> threads;
  std::mutex mutex;
  std::latch left(kCalls);
  for (int i = 0; i < kCalls; ++i) {
    const std::lock_guard made(mutex);  // also `threads`, where gRPC's own order is not seen
    Call& call = *calls.emplace_back(std::make_unique<Call>());
    call.request = grpc::ByteBuffer(&nothing, 1);
    stub.UnaryCall(&call.context, "/none/None", {}, &call.request, &call.response,
                   [&](const grpc::Status& status) {
                     EXPECT_FALSE(status.ok());
                     std::this_thread::sleep_for(1ms);  // time for another thread to help
                     {
                       const std::lock_guard lock(mutex);
                       threads.insert(std::this_thread::get_id());
                     }
                     left.count_down();
                   });
  }
  left.wait();
  return threads.size();
}

TEST(OnePoller, IsTheOnlyThreadThatReactsWhileItIsHeld) {
  if (sysconf(_SC_NPROCESSORS_CONF) > 5) GTEST_SKIP() << "gRPC has more than two threads here";
  EXPECT_EQ(wire::hold_one_poller(), nullptr) << "not preferred yet";
  EXPECT_EQ(reacting_threads(), 2u);
  wire::prefer_one_poller();
  EXPECT_EQ(reacting_threads(), 2u) << "not held yet";
  for (int round = 0; round < 3; ++round) {
    std::shared_ptr<void> first = wire::hold_one_poller(), second = wire::hold_one_poller();
    ASSERT_NE(first, nullptr);
    EXPECT_EQ(first, second) << "held together";
    EXPECT_EQ(reacting_threads(), 1u);
    first.reset();
    EXPECT_EQ(reacting_threads(), 1u) << "still held";
    second.reset();
    EXPECT_EQ(reacting_threads(), 2u) << "let go";
  }
}

// A poller that ends while another one begins must not leave both threads kept.
TEST(OnePoller, MayBeHeldAndLetGoByManyThreadsAtOnce) {
  if (sysconf(_SC_NPROCESSORS_CONF) > 5) GTEST_SKIP() << "gRPC has more than two threads here";
  wire::prefer_one_poller();
  std::vector<std::jthread> threads;
  for (int i = 0; i < 4; ++i)
    threads.emplace_back([] {
      for (int k = 0; k < 100; ++k) wire::hold_one_poller();
    });
  threads.clear();
  const std::shared_ptr<void> held = wire::hold_one_poller();
  EXPECT_EQ(reacting_threads(), 1u);
}

/// How long a reaction waits for its thread, ms, after nothing has happened for a while.
double latency_ms(std::chrono::milliseconds idle) {
  std::this_thread::sleep_for(idle);
  grpc::GenericStub stub(channel_to_nobody());
  const grpc::Slice nothing("", 1);
  Call call;
  call.request = grpc::ByteBuffer(&nothing, 1);
  std::latch done(1);
  const auto begin = std::chrono::steady_clock::now();
  stub.UnaryCall(&call.context, "/none/None", {}, &call.request, &call.response,
                 [&](const grpc::Status&) { done.count_down(); });
  done.wait();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin)
      .count();
}

// gRPC's threads look away for 100 ms when nothing has happened for a second, which a frame each
// 1.05 s would meet every time.
TEST(OnePoller, DoesNotLookAwayWhenNothingHappens) {
  if (sysconf(_SC_NPROCESSORS_CONF) > 5) GTEST_SKIP() << "gRPC has more than two threads here";
  wire::prefer_one_poller();
  const std::shared_ptr<void> held = wire::hold_one_poller();
  std::vector<double> ms;
  for (int i = 0; i < 5; ++i) ms.push_back(latency_ms(1050ms));
  std::sort(ms.begin(), ms.end());
  EXPECT_LT(ms[2], 25.0) << "median of five";
}

}  // namespace
}  // namespace holdfast
