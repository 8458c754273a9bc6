// What some clients do must not cost others: the times of a well-behaved session, alone and beside
// one that floods. Times are ratios within one run, and the best of a few attempts counts: the
// machine has other work.
#include <algorithm>
#include <atomic>
#include <cmath>

#include "tests/service/fault_fixture.h"

namespace holdfast {
namespace {

using namespace std::chrono_literals;
using test::Clock;
using test::Fault;
using test::RawClient;
using test::RawStream;
using test::seconds_since;
using test::ServerProcess;
using test::Session;

// The goal on a machine of its own is 1.5, which tests/faults.sh shows. Sanitizers also watch what
// a flood costs: there the test shows that nobody is left to wait for its end.
constexpr double kMost = test::kSanitized ? 20 : 2.5;

class Fairness : public Fault {
 protected:
  Fairness() { config = test::small_config(160, 90); }

  /// Milliseconds from submit to answer of a session that sends a frame at a time, sorted.
  std::vector<double> times(Session& session, int frames) {
    std::vector<double> out;
    for (int i = 0; i < frames; ++i) {
      const auto start = Clock::now();
      pass(session, next_++);
      out.push_back(1e3 * seconds_since(start));
      std::this_thread::sleep_for(5ms);
    }
    std::sort(out.begin(), out.end());
    return out;
  }
  /// Runs `flood` (until its argument is true) beside a session. The machine's load comes and goes,
  /// and the admitted session's share of the machine is at worst half of it while one other
  /// filters: its median may double, and what it waits for besides is one frame of the other.
  template <class Flood>
  void expect_fair(Session& session, const Flood& flood, double most) {
    const bool table = std::getenv("HOLDFAST_FAULT_TABLE") != nullptr;
    const int frames = table ? 200 : 30;
    Ratios best{HUGE_VAL, HUGE_VAL, HUGE_VAL};
    for (int attempt = 0; attempt < 6 && (best.p90 > most || (table && attempt < 3)); ++attempt) {
      const auto alone = times(session, frames);
      std::atomic<bool> stop{false}, ready{false};
      std::thread other([&] {
        flood(stop, ready);
        ready = true;
      });
      for (int i = 0; i < 1000 && !ready; ++i) std::this_thread::sleep_for(10ms);
      std::this_thread::sleep_for(100ms);
      const auto beside = times(session, frames);
      stop = true;
      other.join();
      const auto at = [&](double share) {
        const auto k = static_cast<std::size_t>(share * frames);
        return beside[k] / alone[k];
      };
      if (at(0.9) < best.p90) best = {at(0.5), at(0.9), at(0.99)};
    }
    EXPECT_LT(best.p90, most);
    if (table)
      std::printf("FAIR|%s|%.2f|%.2f|%.2f\n",
                  ::testing::UnitTest::GetInstance()->current_test_info()->name(), best.p50,
                  best.p90, best.p99);
  }

 private:
  struct Ratios {
    double p50, p90, p99;
  };
  int next_ = 0;
};

TEST_F(Fairness, FloodOfSessionsIsRefusedAndSlowsNobodyDown) {
  const ServerProcess server(socket.address(), {"--max-sessions", "2"});
  Session session = connect();
  Session second = connect();
  std::atomic<int> refused{0};
  expect_fair(
      session,
      [&](const std::atomic<bool>& stop, std::atomic<bool>& ready) {
        ready = true;
        RawClient client(socket.address());
        for (; !stop; std::this_thread::sleep_for(1ms))
          refused += client.create(config).ok() ? 0 : 1;
      },
      kMost);
  EXPECT_GT(refused, 10);
}

TEST_F(Fairness, FloodOfFramesIsHeldToItsRate) {
  const ServerProcess server(socket.address(), {"--max-frames-per-second", "20"});
  Session session = connect();
  expect_fair(
      session,
      [&](const std::atomic<bool>& stop, std::atomic<bool>& ready) {
        ready = true;
        Session greedy = connect();
        std::thread sender([&] {
          for (int i = 0; !stop; ++i) greedy.submit(test::small_frame(config, i));
          greedy.finish();
        });
        while (greedy.receive()) {
        }
        sender.join();
      },
      kMost);
}

TEST_F(Fairness, FloodOfBytesIsHeldToItsRate) {
  const ServerProcess server(socket.address(), {"--max-bytes-per-second", "20000000"});
  Session session = connect();
  const DenoiserConfig large = test::small_config(640, 400);
  expect_fair(
      session,
      [&](const std::atomic<bool>& stop, std::atomic<bool>& ready) {
        ready = true;
        RawClient client(socket.address());
        if (!client.create(large).ok()) return;
        RawStream stream(client);
        stream.attach();
        std::thread reader([&] {
          while (stream.read().message_case() != v1::DenoiseResponse::MESSAGE_NOT_SET) {
          }
        });
        const Frame frame = test::small_frame(large, 0);  // answered from memory after the first
        while (!stop && stream.write(frame, large)) {
        }
        stream.cancel();
        reader.join();
      },
      kMost);
}

TEST_F(Fairness, SlowReaderSlowsNobodyDown) {
  const ServerProcess server(socket.address());
  Session session = connect();
  const DenoiserConfig large = test::small_config(640, 400);
  expect_fair(
      session,
      [&](const std::atomic<bool>& stop, std::atomic<bool>& ready) {
        RawClient client(socket.address());
        if (!client.create(large).ok()) return;
        RawStream stream(client);
        stream.attach();
        std::thread writer([&] {  // more than the windows hold; nothing is read
          for (int i = 0; i < 40 && stream.write(test::small_frame(large, i), large); ++i) {
          }
        });
        for (std::uint64_t filtered = 0, before = 1; filtered != before;) {  // until it is stuck
          std::this_thread::sleep_for(500ms);
          before = std::exchange(filtered, client.get().frames());
        }
        ready = true;
        while (!stop) std::this_thread::sleep_for(5ms);
        stream.cancel();
        writer.join();
      },
      kMost);
}

TEST_F(Fairness, SessionThatFiltersAllTheTimeTakesNoMoreThanItsShare) {
  const ServerProcess server(socket.address());
  Session session = connect();
  expect_fair(
      session,
      [&](const std::atomic<bool>& stop, std::atomic<bool>& ready) {
        ready = true;
        Session busy = connect();
        for (int i = 0; !stop; ++i) {
          busy.submit(test::small_frame(config, i));
          busy.receive();
        }
      },
      2 * kMost);  // half of the machine, and one frame of the other before it
}

}  // namespace
}  // namespace holdfast
