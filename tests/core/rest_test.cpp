#include <utility>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "tests/core/rest_world.h"

namespace holdfast {
namespace {

using test::kAtRest;
using test::RestingSession;
using test::RestWorld;

const PlaneId kShadow = test::of_light(PlaneKind::kVisibility);
const PlaneId kSignals[] = {kShadow, test::kGlossyPlane, test::kIndirectPlane};

bool rested(const FrameReport& report, PlaneId signal) {
  return std::any_of(report.rested.begin(), report.rested.end(),
                     [&](Component c) { return component_plane(c) == signal; });
}

TEST(Rest, BeginsWhenHistoriesHaveSettledAndRunsEachComponentOnceInFourFrames) {
  const RestWorld world;
  Denoiser denoiser(world.config);
  PlaneSet results;
  int filtered[3] = {}, at_once = 0;
  std::size_t stages = 0;
  for (int index = 0; index < kAtRest + 40; ++index) {
    const FrameReport report = denoiser.filter(world.frame(index), results);
    if (index <= RestTurns::kSettling) {
      EXPECT_TRUE(report.rested.empty()) << index;
      stages = report.stages.size();
    }
    if (index < kAtRest) continue;
    EXPECT_GE(report.rested.size(), 2u) << index;
    EXPECT_LT(report.stages.size(), stages);
    for (int k = 0; k < 3; ++k) filtered[k] += rested(report, kSignals[k]) ? 0 : 1;
    at_once += report.rested.empty() ? 1 : 0;
  }
  for (const int turns : filtered) EXPECT_EQ(turns, 10);
  EXPECT_EQ(at_once, 0);
}

TEST(Rest, ReturnsTheResultOfTheLastTurnAndTheSkyAsItIsSent) {
  RestingSession session;
  for (int i = 0; i < 12; ++i) {
    const PlaneSet before = std::exchange(session.results, PlaneSet());
    const Frame frame = session.world.frame(session.next);
    session.filter(frame);
    for (const PlaneId id : kSignals) {
      if (!rested(session.report, id)) continue;
      const Plane &was = before.at(id), &is = session.results.at(id), &sent = frame.planes.at(id);
      for (int y = 0; y < is.height(); ++y)
        for (int x = 0; x < is.width(); ++x) {
          const float expected = (y < RestWorld::kSky ? sent : was).channel(0).at(x, y);
          ASSERT_EQ(is.channel(0).at(x, y), expected) << plane_name(id) << x << " " << y;
        }
    }
  }
}

TEST(Rest, DoesNotDependOnWhatTheCallerDoesWithTheResults) {
  RestingSession kept, cleared;
  for (int i = 0; i < 12; ++i) {
    kept.step();
    cleared.results.clear();
    cleared.step();
    ASSERT_TRUE(test::same_bits(kept.results, cleared.results)) << i;
  }
}

TEST(Rest, NeverComesUnderAccurateNorWhereAnyPartOfItIsMissing) {
  const auto rests = [](const DenoiserConfig& config) {
    return Denoiser(config).plan_text().find("at rest") != std::string::npos;
  };
  DenoiserConfig config = test::full_config();
  EXPECT_TRUE(rests(config));
  for (const char* preset : {"accurate", "reference"}) {
    config.preset = preset;
    EXPECT_FALSE(rests(config)) << preset;
  }
  config = test::full_config();
  for (const char* recipe : {"traditional", "paper", "svgf", "reliable-without-light-changes"}) {
    config.recipe = recipe;
    EXPECT_FALSE(rests(config)) << recipe;
  }
  config = test::full_config();
  config.history = "f16";
  EXPECT_FALSE(rests(config));
  RestWorld world(1);
  RestingSession session(world);
  for (int i = 0; i < 8; ++i) {
    session.step();
    EXPECT_TRUE(session.report.rested.empty());
  }
}

TEST(Rest, KeepsOneResultAComponentAndSaysSo) {
  DenoiserConfig config = RestWorld().config;
  const auto bytes = [&](int turns) {
    config.rest_turns = turns;
    return Denoiser(config).memory_bytes();
  };
  const std::size_t more = bytes(4) - bytes(1);
  const std::size_t results = static_cast<std::size_t>(config.width * config.height) * 7 * 4;
  EXPECT_GE(more, results);
  EXPECT_LT(more, 2 * results) << "rows are padded";
  config.rest_turns = 4;
  const std::string plan = Denoiser(config).plan_text();
  for (const char* line :
       {"frame: at rest components take turns, each is filtered in one frame of 4\n",
        "glossy: at rest, turn 1; ", "indirect: at rest, turn 2; ",
        "light0.visibility: at rest, turn 3; ", "kept results, while components rest: "})
    EXPECT_NE(plan.find(line), std::string::npos) << line << plan;
}

TEST(Rest, WithALightThatChangesIsOverInThatVeryFrame) {
  for (int phase = 0; phase < 4; ++phase) {
    RestingSession session;
    for (int i = 0; i < phase; ++i) session.step();
    session.filter(session.world.frame(session.next, 0.5));
    EXPECT_TRUE(session.report.rested.empty()) << phase;
    EXPECT_EQ(session.report.changes.size(), 3u) << phase;
    for (int i = 0; i < RestTurns::kSettling; ++i) {
      session.filter(session.world.frame(session.next, 0.5));
      ASSERT_TRUE(session.report.rested.empty()) << i;
    }
  }
}

TEST(Rest, WithWhateverMovesIsOverInThatVeryFrame) {
  const std::pair<const char*, void (*)(Frame&)> moves[] = {
      {"cut", [](Frame& f) { f.cut = true; }},
      {"camera", [](Frame& f) { f.camera.view_from_world[3][0] += 1e-9; }},
      {"jitter", [](Frame& f) { f.camera.jitter_px.x = 0.25; }},
      {"object", [](Frame& f) { f.objects[2][3][0] += 1e-9; }},
      {"new object", [](Frame& f) { f.objects[9] = glm::dmat4(1); }},
      {"light", [](Frame& f) { f.lights[0][3][0] += 1e-9; }},
      {"depth", [](Frame& f) { f.planes.find(test::kDepthPlane)->channel(0).at(9, 31) = 4.99f; }},
      {"id", [](Frame& f) { f.planes.find(test::kIdPlane)->ids().at(47, 31) = 7; }}};
  for (const auto& [name, move] : moves) {
    RestingSession session;
    Frame frame = session.world.frame(session.next);
    move(frame);
    session.filter(frame);
    EXPECT_TRUE(session.report.rested.empty()) << name;
    for (int i = 0; i < 8; ++i) {
      session.step();
      EXPECT_TRUE(session.report.rested.empty()) << name;
    }
  }
}

TEST(Rest, OfASceneInWhichOneObjectMovesNeverComes) {
  RestWorld world;
  Denoiser denoiser(world.config);
  PlaneSet results;
  for (int index = 0; index < kAtRest + 8; ++index) {
    Frame frame = world.frame(index);
    frame.objects[2] = glm::translate(glm::dmat4(1), {1e-3 * index, 0, 0});
    EXPECT_TRUE(denoiser.filter(frame, results).rested.empty()) << index;
  }
}

TEST(Rest, RepairsAndCountsBadValuesAsEver) {
  RestingSession session;
  for (int i = 0; i < 8; ++i) {
    Frame frame = session.world.frame(session.next);
    for (const PlaneId id : kSignals) {
      frame.planes.find(id)->channel(0).at(5, 9) = test::kNaN;
      frame.planes.find(id)->channel(0).at(6, 1) = test::kInf;  // sky
    }
    session.filter(frame);
    EXPECT_FALSE(session.report.rested.empty());
    ASSERT_EQ(session.report.repaired.size(), 3u);
    for (const RepairCount& count : session.report.repaired) EXPECT_EQ(count.values, 2u);
    EXPECT_EQ(session.report.non_finite_out, 0u);
    for (const Plane& plane : session.results)
      for (int c = 0; c < plane.channels(); ++c)
        EXPECT_TRUE(std::isfinite(plane.channel(c).at(5, 9)) &&
                    std::isfinite(plane.channel(c).at(6, 1)));
  }
}

TEST(Rest, EndsWhereLightReachesASurfaceForTheFirstTimeAtAnyResolution) {
  for (const char* preset : {"balanced", "fast"}) {
    SCOPED_TRACE(preset);
    RestWorld world;
    world.config.preset = preset;
    RestingSession session(world);
    Frame frame = world.frame(session.next);
    // At half resolution (20, 20) is what represents its quad.
    for (int c = 0; c < 3; ++c)
      frame.planes.find(test::of_light(PlaneKind::kUnshadowed))->channel(c).at(20, 20) = 0;
    const auto shadow_is_passed_over = [&] { return rested(session.report, kShadow); };
    session.filter(frame);
    EXPECT_FALSE(shadow_is_passed_over());
    EXPECT_TRUE(rested(session.report, test::kGlossyPlane) ||
                rested(session.report, test::kIndirectPlane));
    session.step();
    EXPECT_FALSE(shadow_is_passed_over());
  }
}

/// The mean of a component's plane over the wall, over that of its truth where `share` of the light
/// is left.
double brightness(const RestingSession& session, PlaneId id, double share) {
  const RestWorld& world = session.world;
  double shown = 0, truth = 0;
  for (int y = RestWorld::kSky; y < world.config.height; ++y)
    for (int x = 0; x < world.config.width; ++x) {
      shown += double{session.results.at(id).channel(0).at(x, y)};
      truth += share * (id == kShadow ? world.visibility(x) : 1);
    }
  return shown / truth;
}

// Light that loses 0.05 % a frame never changes within a frame by what noise hides: only the
// lasting difference (RestFinding::kSlow) ends a rest before the histories of every fifth frame lag
// five times as far behind. Without it 0.115 and 0.09.
TEST(Rest, FollowsLightThatChangesByLessThanItsNoiseAlmostAsAlwaysFilteringDoes) {
  for (const auto& [turns, most] : {std::pair(1, 0.04), {5, 0.055}, {12, 0.055}}) {
    RestingSession session(RestWorld(turns, 64, 51));
    double share = 1, worst[3] = {};
    int passed_over = 0;
    for (int i = 0; i < 400; ++i) {
      share *= 0.9995;
      session.filter(session.world.frame(session.next, share));
      passed_over += static_cast<int>(session.report.rested.size());
      for (int k = 0; k < 3; ++k)
        worst[k] = std::max(worst[k], std::abs(brightness(session, kSignals[k], share) - 1));
    }
    for (int k = 0; k < 3; ++k)
      EXPECT_LT(worst[k], most) << plane_name(kSignals[k]) << ", turns: " << turns;
    EXPECT_EQ(passed_over > 0, turns > 1);
  }
}

TEST(Rest, GivesTheSameBitsOnAnyNumberOfThreads) {
  const auto run = [](int threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(threads));
    RestingSession session;
    for (int i = 0; i < 6; ++i) session.step();
    EXPECT_FALSE(session.report.rested.empty());
    return std::move(session.results);
  };
  EXPECT_TRUE(test::same_bits(run(1), run(4)));
}

TEST(Rest, ComesWithComponentsAtHalfResolutionAndDebugPlanes) {
  RestWorld world;
  world.config.preset = "fast";
  world.config.debug_planes = true;
  RestingSession session(world);
  for (int i = 0; i < 8; ++i) {
    const PlaneSet before = std::exchange(session.results, PlaneSet());
    session.step();
    EXPECT_GE(session.report.rested.size(), 2u);
    for (const Component component : session.report.rested)
      for (const PlaneId id :
           {component_plane(component), PlaneId{PlaneKind::kDebugHistory, component}}) {
        const Plane& is = session.results.at(id);
        for (int y = RestWorld::kSky; y < is.height(); ++y)
          for (int x = 0; x < is.width(); ++x)
            ASSERT_EQ(is.channel(0).at(x, y), before.at(id).channel(0).at(x, y)) << plane_name(id);
      }
  }
  session.filter(world.frame(session.next, 0.5));
  EXPECT_TRUE(session.report.rested.empty());
}

TEST(Rest, EndsWithAChangeOfPresetOrSize) {
  RestingSession session;
  session.denoiser.set_preset("fast");
  session.step();
  EXPECT_TRUE(session.report.rested.empty());
  session.denoiser.set_preset("balanced");
  session.step();
  EXPECT_TRUE(session.report.rested.empty());
  const RestWorld larger(4, 60, 40);
  RestingSession resting;
  Denoiser other(larger.config, resting.denoiser);
  PlaneSet results;
  EXPECT_TRUE(other.filter(larger.frame(resting.next), results).rested.empty());
}

// Filters as narrow as they get, so that the errors of pixels are many and independent.
TEST(Rest, LeavesTheErrorOfAlwaysFiltering) {
  double with[3] = {}, without[3] = {};
  for (std::uint32_t seed = 1; seed <= 4; ++seed) {
    RestWorld world(5), always(1);
    for (RestWorld* of : {&world, &always}) {
      of->seed = 1000 * seed;
      of->config.kernel_taps = 9;
      of->config.more_levels = -3;
    }
    Denoiser resting(world.config), running(always.config);
    PlaneSet a, b;
    for (int index = 0; index < kAtRest + 256; ++index) {
      const Frame frame = world.frame(index);
      resting.filter(frame, a);
      running.filter(frame, b);
      if (index < kAtRest || index % 3 != 0) continue;
      for (int k = 0; k < 3; ++k) {
        with[k] += std::pow(world.error(a, kSignals[k]), 2);
        without[k] += std::pow(world.error(b, kSignals[k]), 2);
      }
    }
  }
  for (int k = 0; k < 3; ++k)
    EXPECT_LT(std::sqrt(with[k] / without[k]), 1.02) << plane_name(kSignals[k]);
}

}  // namespace
}  // namespace holdfast
