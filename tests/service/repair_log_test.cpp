// What the server's log says of values that were repaired, and how often.
#include "server/repair_log.h"

#include <atomic>
#include <cmath>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "tests/service/served.h"
#include "tests/service/test_frames.h"

namespace holdfast {
namespace {

using namespace std::chrono_literals;
using server::RepairLog;

constexpr PlaneId kDepth{PlaneKind::kDepth, {}}, kIndirect{PlaneKind::kIndirect, {}};
const RepairLog::TimePoint kStart{};

FrameReport report_of(std::int64_t frame, std::vector<RepairCount> repaired) {
  FrameReport report;
  report.index = frame;
  report.repaired = std::move(repaired);
  return report;
}

TEST(RepairLog, NamesThePlanesOfTheFirstFrameAtOnce) {
  RepairLog log;
  EXPECT_EQ(log.note(report_of(7, {{kDepth, 3}, {kIndirect, 11}}), kStart),
            "frame=7 frames_since_last=1 lines_suppressed=0 values=\"depth: 3, indirect: 11\"");
}

TEST(RepairLog, SaysNothingOfFramesWithoutRepairs) {
  RepairLog log;
  EXPECT_EQ(log.note(report_of(1, {}), kStart), std::nullopt);
  EXPECT_TRUE(log.note(report_of(2, {{kDepth, 1}}), kStart)) << "and they take no one's turn";
}

TEST(RepairLog, KeepsToOneLineInAnIntervalAndThenTellsOfAllThatItKeptBack) {
  RepairLog log;
  int lines = 0;
  for (int frame = 0; frame < 600; ++frame)  // ten seconds at sixty a second
    lines += log.note(report_of(frame, {{kDepth, 2}}), kStart + frame * 16ms) ? 1 : 0;
  EXPECT_EQ(lines, 1);
  EXPECT_EQ(log.note(report_of(600, {{kIndirect, 5}}), kStart + RepairLog::kInterval),
            "frame=600 frames_since_last=600 lines_suppressed=599 "
            "values=\"depth: 1198, indirect: 5\"");
  EXPECT_EQ(log.note(report_of(601, {{kDepth, 2}}), kStart + RepairLog::kInterval + 1ms),
            std::nullopt);
  EXPECT_EQ(log.note(report_of(900, {{kDepth, 2}}), kStart + 3 * RepairLog::kInterval),
            "frame=900 frames_since_last=2 lines_suppressed=1 values=\"depth: 4\"")
      << "counts start anew";
}

TEST(RepairLog, ManyThreadsStillMakeOneLine) {
  RepairLog log;
  std::atomic<int> lines = 0;
  std::vector<std::thread> threads;
  for (int k = 0; k < 4; ++k)
    threads.emplace_back([&] {
      for (int frame = 0; frame < 1000; ++frame)
        lines += log.note(report_of(frame, {{kDepth, 1}}), kStart) ? 1 : 0;
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(lines, 1);
  const auto last = log.note(report_of(1, {{kDepth, 1}}), kStart + RepairLog::kInterval);
  ASSERT_TRUE(last);
  EXPECT_NE(last->find("depth: 4000"), std::string::npos) << *last;
}

TEST(RepairLog, AServerLogsASessionOfBadFramesOnce) {
  server::ServerConfig config = test::server_config(1);
  config.log_level = "warn";
  testing::internal::CaptureStderr();
  {
    const server::Server server(config);
    const DenoiserConfig session = test::small_config();
    std::vector<Frame> frames;
    for (int t = 0; t < 12; ++t) {
      frames.push_back(test::small_frame(session, t));
      frames.back().planes.find({PlaneKind::kDepth, {}})->channel(0).at(3, t) = NAN;
    }
    test::served(server, session, frames);
  }
  const std::string log = testing::internal::GetCapturedStderr();
  const std::size_t first = log.find("event=repaired session=");
  ASSERT_NE(first, std::string::npos) << log;
  EXPECT_NE(log.find("frame=0 frames_since_last=1 lines_suppressed=0 values=\"depth: 1\""),
            std::string::npos)
      << log;
  EXPECT_EQ(log.find("event=repaired", first + 1), std::string::npos) << log;
}

}  // namespace
}  // namespace holdfast
