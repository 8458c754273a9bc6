#include <thread>

#include <gtest/gtest.h>

#include "server/session.h"
#include "tests/core/rest_world.h"

namespace holdfast::server {
namespace {

using namespace std::chrono_literals;

constexpr double kBudgetMs = 200;

/// `balanced` should take 2 ms, and `accurate` far more than the budget.
SessionConfig budgeted(const DenoiserConfig& denoiser) {
  SessionConfig config;
  config.denoiser = denoiser;
  config.budget_ms = kBudgetMs;
  config.preset_ms = {1, 2, 1e6};
  return config;
}

/// A frame that others have kept from the core for more than the budget.
std::shared_ptr<const Answer> late(Session& session, Frame frame) {
  const auto complete = Session::TimePoint::clock::now();
  std::this_thread::sleep_for(std::chrono::duration<double, std::milli>(1.2 * kBudgetMs));
  return session.filter(frame, 0, complete);
}

// Only frames in which all components are filtered tell what a preset costs, and a change of preset
// ends the rest: at rest not even a budget that is missed in every frame changes anything.
TEST(BudgetAtRest, IsNotJudgedByFramesInWhichComponentsRest) {
  const test::RestWorld world;
  Session session("a", "b", budgeted(world.config), 1);
  std::int64_t next = 0;
  for (; next < test::kAtRest; ++next) {
    Frame frame = world.frame(next);
    session.filter(frame, 0);
  }
  for (int i = 0; i < 5; ++i) {
    const auto answer = late(session, world.frame(next++));
    EXPECT_FALSE(answer->report.rested.empty()) << i;
    EXPECT_EQ(answer->report.preset, "balanced") << i;
  }
  std::string preset;
  for (int i = 0; i < 5; ++i) {
    Frame frame = world.frame(next++);
    frame.camera.view_from_world[3][0] += 0.01 * (i + 1);
    const auto answer = late(session, std::move(frame));
    EXPECT_TRUE(answer->report.rested.empty()) << i;
    preset = answer->report.preset;
  }
  EXPECT_EQ(preset, "fast") << "the same waits count where all is filtered";
}

}  // namespace
}  // namespace holdfast::server
