#include "server/scheduler.h"

#include <atomic>
#include <latch>
#include <mutex>

#include <gtest/gtest.h>
#include <oneapi/tbb/parallel_for.h>

namespace holdfast::server {
namespace {

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

TEST(Scheduler, LetsStrandsTakeTurnsWhateverTheLengthOfTheirQueues) {
  std::vector<char> order;
  {
    Scheduler scheduler(1);
    const auto greedy = std::make_shared<Strand>(), modest = std::make_shared<Strand>();
    std::latch posted(1);
    scheduler.post(greedy, [&] { posted.wait(); });
    for (int i = 0; i < 10; ++i) scheduler.post(greedy, [&] { order.push_back('g'); });
    for (int i = 0; i < 3; ++i) scheduler.post(modest, [&] { order.push_back('m'); });
    posted.count_down();
  }
  EXPECT_EQ(std::string(order.begin(), order.end()), "mgmgmgggggggg");
}

TEST(Scheduler, UsesNoMoreThreadsThanItWasGiven) {
  for (const int threads : {1, 2}) {
    std::atomic<int> now{0}, most{0};
    {
      Scheduler scheduler(threads);
      for (int s = 0; s < 4; ++s)
        scheduler.post(std::make_shared<Strand>(), [&] {
          oneapi::tbb::parallel_for(0, 64, [&](int) {
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
