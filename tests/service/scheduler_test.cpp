#include "server/scheduler.h"

#include <atomic>
#include <latch>
#include <mutex>

#include <gtest/gtest.h>

#include "core/kernels/parallel.h"

namespace holdfast::server {
namespace {

using namespace std::chrono_literals;

TEST(Scheduler, RunsTheJobsOfAStrandInOrderOnAnyNumberOfThreads) {
  for (const int threads : {1, 2, 8}) {
    std::vector<int> order;  // no mutex: jobs of one strand never overlap
    {
      Scheduler scheduler(threads);
      const auto strand = std::make_shared<Strand>();
      for (int i = 0; i < 200; ++i) scheduler.post(strand, [&order, i] { order.push_back(i); });
    }
    ASSERT_EQ(order.size(), 200u);
    for (int i = 0; i < 200; ++i) EXPECT_EQ(order[static_cast<std::size_t>(i)], i);
  }
}

/// A clock that each look at moves on, and jobs as well: only one thread runs them.
class ManualClock {
 public:
  explicit ManualClock(std::chrono::milliseconds step = 0ms) : step_(step) {}
  Scheduler::Clock now() {
    return [this] { return time_ += step_; };
  }
  void pass(std::chrono::milliseconds time) { time_ += time; }

 private:
  const std::chrono::milliseconds step_;
  std::chrono::steady_clock::time_point time_{};
};

TEST(Scheduler, SharesTheMachineByTimeBetweenLargeAndSmallFrames) {
  std::string order;
  {
    ManualClock clock;
    Scheduler scheduler(1, clock.now());
    const auto large = std::make_shared<Strand>(), small = std::make_shared<Strand>();
    std::latch posted(1);
    scheduler.post(std::make_shared<Strand>(), [&] { posted.wait(); });
    for (int i = 0; i < 3; ++i) scheduler.post(large, [&] { order += 'L', clock.pass(40ms); });
    for (int i = 0; i < 12; ++i) scheduler.post(small, [&] { order += 's', clock.pass(10ms); });
    posted.count_down();
  }
  EXPECT_EQ(order, "LssssLssssLssss");
}

TEST(Scheduler, GivesAStrandThatWasIdleNoTimeSavedUp) {
  std::string order;
  {
    ManualClock clock;
    Scheduler scheduler(1, clock.now());
    const auto busy = std::make_shared<Strand>(), late = std::make_shared<Strand>();
    std::latch posted(1), reached(1);
    for (int i = 0; i < 4; ++i) scheduler.post(busy, [&] { order += 'b', clock.pass(10ms); });
    scheduler.post(busy, [&] {
      reached.count_down();
      posted.wait();
      clock.pass(10ms);
    });
    // `late` comes when `busy` has used 40 ms; it begins there and the two alternate.
    reached.wait();
    for (int i = 0; i < 3; ++i) scheduler.post(late, [&] { order += 'l', clock.pass(10ms); });
    for (int i = 0; i < 2; ++i) scheduler.post(busy, [&] { order += 'b', clock.pass(10ms); });
    posted.count_down();
  }
  EXPECT_EQ(order, "bbbblblbl");
}

TEST(Scheduler, LetsStrandsTakeTurnsWhateverTheLengthOfTheirQueues) {
  std::vector<char> order;
  {
    ManualClock clock(1ms);
    Scheduler scheduler(1, clock.now());
    const auto greedy = std::make_shared<Strand>(), modest = std::make_shared<Strand>();
    std::latch posted(1);
    scheduler.post(greedy, [&] { posted.wait(); });
    for (int i = 0; i < 10; ++i) scheduler.post(greedy, [&] { order.push_back('g'); });
    for (int i = 0; i < 3; ++i) scheduler.post(modest, [&] { order.push_back('m'); });
    posted.count_down();
  }
  EXPECT_EQ(std::string(order.begin(), order.end()), "mgmgmgggggggg");
}

TEST(Scheduler, TakesTheEarliestDeadlineFirstAmongThoseThatHaveUsedAboutTheSame) {
  std::string order;
  {
    ManualClock clock;
    Scheduler scheduler(1, clock.now());
    std::latch posted(1);
    scheduler.post(std::make_shared<Strand>(), [&] { posted.wait(); });
    const std::chrono::steady_clock::time_point start{};
    scheduler.post(std::make_shared<Strand>(), [&] { order += 'n'; });
    scheduler.post(
        std::make_shared<Strand>(), [&] { order += 'l'; }, start + 90ms);
    scheduler.post(
        std::make_shared<Strand>(), [&] { order += 'e'; }, start + 30ms);
    posted.count_down();
  }
  EXPECT_EQ(order, "eln");
}

TEST(Scheduler, LendsNoMoreThanTheSlackToWhoHasDeadlines) {
  std::string order;
  {
    ManualClock clock;
    Scheduler scheduler(1, clock.now());
    const auto hasty = std::make_shared<Strand>(), patient = std::make_shared<Strand>();
    std::latch posted(1);
    scheduler.post(std::make_shared<Strand>(), [&] { posted.wait(); });
    const std::chrono::steady_clock::time_point long_past{};
    for (int i = 0; i < 8; ++i)
      scheduler.post(
          hasty, [&] { order += 'h', clock.pass(10ms); }, long_past);
    for (int i = 0; i < 4; ++i) scheduler.post(patient, [&] { order += 'p', clock.pass(10ms); });
    posted.count_down();
  }
  // Never more than 40 ms and the frame at hand ahead.
  EXPECT_EQ(order, "hhhhhphphphp");
}

TEST(Scheduler, LetsThoseWhoKeepUpGoInTheOrderInWhichTheyCameHoweverTheirFramesDiffer) {
  std::string order;
  {
    ManualClock clock;
    Scheduler scheduler(1, clock.now());
    const auto dear = std::make_shared<Strand>(), cheap = std::make_shared<Strand>();
    scheduler.post(dear, [&] { clock.pass(30ms); });
    scheduler.post(cheap, [&] { clock.pass(1ms); });
    std::latch posted(1), both(2), held(1);
    for (const auto& strand : {dear, cheap}) scheduler.post(strand, [&] { both.count_down(); });
    both.wait();
    scheduler.post(std::make_shared<Strand>(), [&] { held.count_down(), posted.wait(); });
    held.wait();  // the jobs before are over and booked
    scheduler.post(dear, [&] { order += 'd'; });
    scheduler.post(cheap, [&] { order += 'c'; });
    posted.count_down();
  }
  EXPECT_EQ(order, "dc") << "and not that of the time used";
}

TEST(Scheduler, LetsThoseWhoKeepUpGoBeforeThoseWhoFlood) {
  std::string order;
  {
    ManualClock clock;
    Scheduler scheduler(1, clock.now());
    std::latch posted(1), reached(1);
    const std::shared_ptr<Strand> floods[] = {std::make_shared<Strand>(),
                                              std::make_shared<Strand>()};
    for (const auto& flood : floods)
      for (int i = 0; i < 3; ++i)
        scheduler.post(flood, [&, i] {
          order += 'f';
          clock.pass(10ms);
          if (i != 1 || order.size() != 3) return;
          reached.count_down();
          posted.wait();
        });
    reached.wait();
    scheduler.post(std::make_shared<Strand>(), [&] { order += 'k', clock.pass(10ms); });
    posted.count_down();
  }
  EXPECT_EQ(order, "fffkfff") << "though the other flood came first and has used as little";
}

/// Jobs of sessions that keep the latest, posted in the order of their letters while another runs.
TEST(Scheduler, TakesTheNewestFirstOfThoseWhoWantThat) {
  std::string order;
  {
    ManualClock clock;
    Scheduler scheduler(1, clock.now());
    std::latch posted(1);
    scheduler.post(std::make_shared<Strand>(), [&] { posted.wait(); });
    const std::chrono::steady_clock::time_point start{};
    const auto renewed = std::make_shared<Strand>();
    const auto post = [&](const std::shared_ptr<Strand>& strand, char letter,
                          std::chrono::milliseconds due) {
      scheduler.post(
          strand, [&order, letter] { order += letter; }, start + due, true);
    };
    post(renewed, 'a', 10ms);
    post(std::make_shared<Strand>(), 'b', 20ms);
    post(std::make_shared<Strand>(), 'c', 30ms);
    post(renewed, 'd', 40ms);
    posted.count_down();
  }
  EXPECT_EQ(order, "adcb") << "a newer job brings its strand forward, and jobs keep their order";
}

TEST(Scheduler, HoldsThoseWhoWantTheNewestFirstToTheirShare) {
  std::string order;
  {
    ManualClock clock;
    Scheduler scheduler(1, clock.now());
    std::latch posted(1);
    scheduler.post(std::make_shared<Strand>(), [&] { posted.wait(); });
    const auto modest = std::make_shared<Strand>(), greedy = std::make_shared<Strand>();
    for (int i = 0; i < 4; ++i)
      scheduler.post(
          modest, [&] { order += 'm', clock.pass(10ms); }, {}, true);
    for (int i = 0; i < 8; ++i)
      scheduler.post(
          greedy, [&] { order += 'g', clock.pass(10ms); }, {}, true);
    posted.count_down();
  }
  EXPECT_EQ(order, "gggggmgmgmgm") << "never more than 40 ms and the frame at hand ahead";
}

TEST(Scheduler, SharesByTimeBetweenThoseWhoWantTheNewestFirstAndOthers) {
  std::string order;
  {
    ManualClock clock;
    Scheduler scheduler(1, clock.now());
    std::latch posted(1);
    scheduler.post(std::make_shared<Strand>(), [&] { posted.wait(); });
    const auto all = std::make_shared<Strand>(), latest = std::make_shared<Strand>();
    for (int i = 0; i < 4; ++i) scheduler.post(all, [&] { order += 'a', clock.pass(10ms); });
    for (int i = 0; i < 4; ++i)
      scheduler.post(
          latest, [&] { order += 'l', clock.pass(10ms); }, {}, true);
    posted.count_down();
  }
  EXPECT_EQ(order, "alalalal");
}

TEST(Scheduler, UsesNoMoreThreadsThanItWasGiven) {
  for (const int threads : {1, 2}) {
    std::atomic<int> now{0}, most{0};
    {
      Scheduler scheduler(threads);
      for (int s = 0; s < 4; ++s)
        scheduler.post(std::make_shared<Strand>(), [&] {
          for_each_index(0, 64, 1, [&](int) {
            const int running = ++now;
            int seen = most;
            while (running > seen && !most.compare_exchange_weak(seen, running)) {
            }
            std::this_thread::sleep_for(std::chrono::microseconds(200));
            --now;
          });
        });
    }
    EXPECT_LE(most, threads);
  }
}

}  // namespace
}  // namespace holdfast::server
