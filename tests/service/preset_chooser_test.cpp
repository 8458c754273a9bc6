#include "server/preset_chooser.h"

#include <algorithm>
#include <functional>
#include <random>

#include <gtest/gtest.h>

#include "server/cost_model.h"

namespace holdfast::server {
namespace {

const std::vector<double> kExpected{4, 10, 12};  // ms; fast, balanced, accurate

/// What happened in a simulated session: the preset of each frame.
struct Played {
  std::vector<std::size_t> presets;
  int switches(std::size_t from = 0) const {
    int count = 0;
    for (std::size_t i = std::max<std::size_t>(from, 1); i < presets.size(); ++i)
      count += presets[i] != presets[i - 1] ? 1 : 0;
    return count;
  }
};

/// What a frame takes: `cost(frame, preset)` in the core, `wait(frame)` for others.
using Cost = std::function<double(int frame, std::size_t preset)>;

Played play(
    PresetChooser& chooser, int frames, const Cost& cost,
    const std::function<double(int)>& wait = [](int) { return 0.0; }) {
  Played played;
  for (int i = 0; i < frames; ++i) {
    played.presets.push_back(chooser.preset());
    chooser.measured(cost(i, chooser.preset()), wait(i));
  }
  return played;
}

double expected(std::size_t preset) { return kExpected[preset]; }

TEST(PresetChooser, BeginsWithTheBestPresetThatShouldStayClearOfTheBudget) {
  EXPECT_EQ(PresetChooser(kExpected, 100).preset(), 2u);
  EXPECT_EQ(PresetChooser(kExpected, 13).preset(), 1u) << "12 is above 0.85 of 13";
  EXPECT_EQ(PresetChooser(kExpected, 11).preset(), 0u);
  EXPECT_EQ(PresetChooser(kExpected, 0.1).preset(), 0u) << "an impossible budget";
}

TEST(PresetChooser, AnImpossibleBudgetStaysOnTheFastestPreset) {
  PresetChooser chooser(kExpected, 1);
  const Played played = play(chooser, 5000, [](int, std::size_t p) { return expected(p); });
  EXPECT_EQ(played.switches(), 0);
  EXPECT_EQ(chooser.preset(), 0u);
}

TEST(PresetChooser, ConstantCostsSettleWhateverTheBudgetAndTheMachine) {
  for (const double speed : {0.1, 0.5, 1.0, 2.0, 10.0})
    for (double budget = 1; budget < 60; budget += 0.5) {
      PresetChooser chooser(kExpected, budget);
      const auto cost = [&](int, std::size_t p) { return speed * expected(p); };
      const Played played = play(chooser, 3000, cost);
      EXPECT_LE(played.switches(), 2) << budget << " ms, " << speed;
      EXPECT_EQ(played.switches(300), 0) << budget << " ms, " << speed;
      if (speed * kExpected[0] <= budget) {
        EXPECT_LE(cost(0, chooser.preset()), budget) << budget << " ms, " << speed;
      }
      const std::size_t better = chooser.preset() + 1;
      if (better == kExpected.size()) continue;
      EXPECT_GT(cost(0, better), PresetChooser::kClear * budget) << budget << " ms, " << speed;
    }
}

TEST(PresetChooser, MoreLoadLowersThePresetInOrderWithinEightFramesAndLessRaisesItAgain) {
  PresetChooser chooser(kExpected, 20);
  int load_from = 100, load_to = 600;
  const auto cost = [&](int i, std::size_t p) {
    return expected(p) * (i >= load_from && i < load_to ? 4.0 : 1.0);
  };
  const Played played = play(chooser, 1200, cost);
  const auto& presets = played.presets;
  EXPECT_EQ(presets[99], 2u);
  EXPECT_EQ(presets[108], 0u);
  EXPECT_TRUE(
      std::is_sorted(presets.begin() + 100, presets.begin() + 600, std::greater<std::size_t>()))
      << "while the load lasts nothing is raised";
  EXPECT_TRUE(std::is_sorted(presets.begin() + 600, presets.end()));
  EXPECT_EQ(presets[700], 2u) << "recovered within 100 frames, step by step";
  EXPECT_NE(std::find(presets.begin() + 600, presets.end(), 1u), presets.end());
}

TEST(PresetChooser, WaitingForOtherSessionsCountsForTheBudget) {
  PresetChooser chooser(kExpected, 20);
  const Played played = play(
      chooser, 1000, [](int, std::size_t p) { return expected(p); },
      [](int i) { return i >= 100 && i < 500 ? 15.0 : 0.0; });
  EXPECT_EQ(played.presets[99], 2u);
  EXPECT_EQ(played.presets[120], 0u);
  EXPECT_EQ(std::count(played.presets.begin() + 120, played.presets.begin() + 500, 0u), 380)
      << "15 + 10 ms would not keep to it";
  EXPECT_EQ(played.presets[999], 2u);
}

TEST(PresetChooser, OneLateFrameChangesNothing) {
  PresetChooser chooser(kExpected, 20);
  const Played played = play(
      chooser, 2000, [](int i, std::size_t p) { return expected(p) * (i % 10 == 0 ? 10.0 : 1.0); });
  EXPECT_EQ(played.switches(), 0);
}

TEST(PresetChooser, NoiseDoesNotMakeItPump) {
  for (double budget = 4; budget < 40; budget += 1)
    for (const unsigned seed : {1u, 2u, 3u}) {
      std::mt19937 random(seed);
      std::lognormal_distribution<double> noise(0, 0.15);
      PresetChooser chooser(kExpected, budget);
      const int frames = 10000;
      const Played played =
          play(chooser, frames, [&](int, std::size_t p) { return expected(p) * noise(random); });
      EXPECT_LE(played.switches(), 24) << budget << " ms, seed " << seed;
      EXPECT_LE(played.switches(frames / 2), 10) << budget << " ms, seed " << seed;
    }
}

// The presets' costs relate otherwise than expected: the better one looks affordable and is not.
TEST(PresetChooser, LearnsWhatABetterPresetCostsAndTriesItEverMoreRarely) {
  PresetChooser chooser({4, 5, 6}, 20);
  const std::vector<double> truth{10, 25, 40};
  const Played played = play(chooser, 20000, [&](int, std::size_t p) { return truth[p]; });
  EXPECT_LE(played.switches(200), 12);
  const auto wrong = std::count_if(played.presets.begin(), played.presets.end(),
                                   [](std::size_t p) { return p > 0; });
  EXPECT_LE(wrong, 60);
}

TEST(PresetChooser, ALoadThatComesAndGoesIsFollowedEverMoreRarely) {
  PresetChooser chooser(kExpected, 20);
  const Played played = play(chooser, 20000, [](int i, std::size_t p) {
    return expected(p) * (i % 100 < 40 ? 3.0 : 1.0);
  });
  EXPECT_GT(played.switches(), 2);
  EXPECT_LE(played.switches(10000), 40) << "of 200 changes of the load";
}

TEST(PresetChooser, ASessionWithOnePresetKeepsIt) {
  PresetChooser chooser({5}, 1);
  EXPECT_EQ(play(chooser, 100, [](int, std::size_t) { return 5.0; }).switches(), 0);
}

TEST(CostModel, AddsUpThePartsThatASessionHasTimesItsPixels) {
  const CostTable table{{1, 10, 100, 1000}, {2, 20, 200, 2000}, {3, 30, 300, 3000}};
  DenoiserConfig session;
  session.width = 1000;
  session.height = 500;
  session.preset = "accurate";
  session.planes = {{PlaneKind::kDepth, {}},
                    PlaneId::of_light(PlaneKind::kVisibility, 0),
                    PlaneId::of_light(PlaneKind::kVisibility, 3),
                    {PlaneKind::kIndirect, {}}};
  const auto half_a_million = [](double ns) { return ns * 0.5; };
  EXPECT_EQ(
      expected_ms(table, session),
      (std::vector<double>{half_a_million(1021), half_a_million(2042), half_a_million(3063)}));
  session.preset = "balanced";
  EXPECT_EQ(expected_ms(table, session).size(), 2u) << "the session's preset is the best";
}

TEST(CostModel, SortsStagesByWhatTheyBelongTo) {
  const PresetCost cost = cost_of_stages({{"guides", 1, 0},
                                          {"light0.visibility.blend", 2, 0},
                                          {"light0.visibility.filter", 3, 0},
                                          {"glossy.filter", 4, 0},
                                          {"indirect.cones", 5, 0},
                                          {"composite", 6, 0}},
                                         1e6);
  EXPECT_DOUBLE_EQ(cost.frame, 7);
  EXPECT_DOUBLE_EQ(cost.visibility, 5);
  EXPECT_DOUBLE_EQ(cost.glossy, 4);
  EXPECT_DOUBLE_EQ(cost.indirect, 5);
}

}  // namespace
}  // namespace holdfast::server
