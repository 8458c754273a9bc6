// Preset `reference`: a denoiser like any other, but for its speed.

#include <cmath>
#include <utility>

#include "core/frame/error.h"
#include "tests/oracle/within_budget.h"

namespace holdfast {
namespace {

using namespace stability;

struct Door : testing::Test {
  OracleScene scene = std::move(oracle_scenes(24, 16, 3).front());
  DenoiserConfig config = scene.config;
  Door() { config.preset = "reference"; }

  PlaneSet filtered(Denoiser& denoiser, std::size_t frame) {
    PlaneSet results;
    reports.push_back(denoiser.filter(scene.frames[frame], results));
    return results;
  }
  std::vector<FrameReport> reports;
};

/// The largest difference between the composites of two result sets.
double difference(const PlaneSet& a, const PlaneSet& b) {
  const PlaneId id{PlaneKind::kComposite, {}};
  double largest = 0;
  for (int c = 0; c < 3; ++c)
    for (int y = 0; y < 16; ++y)
      for (int x = 0; x < 24; ++x)
        largest = std::max(largest, std::abs(double{a.at(id).channel(c).at(x, y)} -
                                             double{b.at(id).channel(c).at(x, y)}));
  return largest;
}

TEST_F(Door, ReferenceReturnsThePlanesOfTheConfigurationAndReportsTheFrame) {
  Denoiser denoiser(config);
  const PlaneSet results = filtered(denoiser, 0);
  EXPECT_EQ(results.size(), result_planes(config).size());
  filtered(denoiser, 1);
  EXPECT_TRUE(reports[0].history_reset);
  EXPECT_FALSE(reports[1].history_reset);
  EXPECT_GT(reports[1].mean_history_frames, 1.0);
  EXPECT_EQ(reports[1].non_finite_out, 0u);
  EXPECT_EQ(reports[1].stages.front().stage, "guides");
  EXPECT_EQ(reports[1].stages.back().stage, "composite");
  EXPECT_NE(denoiser.plan_text().find("preset reference"), std::string::npos);
}

TEST_F(Door, ResetAndCutForgetHistory) {
  Denoiser once(config), again(config), cut(config);
  const PlaneSet with_history = (filtered(once, 0), filtered(once, 1));
  filtered(again, 0);
  again.reset();
  const PlaneSet after_reset = filtered(again, 1);
  filtered(cut, 0);
  scene.frames[1].cut = true;
  const PlaneSet after_cut = filtered(cut, 1);
  EXPECT_EQ(difference(after_reset, after_cut), 0.0);
  EXPECT_GT(difference(with_history, after_cut), 1e-3);
}

TEST_F(Door, ReferenceFiltersAtHalfResolutionWhatASessionAsksFor) {
  config.half_resolution = {"indirect", "glossy", "visibility"};
  Denoiser denoiser(config);
  const std::size_t before = denoiser.memory_bytes();
  for (std::size_t k = 0; k < 3; ++k) {
    const PlaneSet results = filtered(denoiser, k);
    EXPECT_EQ(results.size(), result_planes(config).size());
    EXPECT_EQ(reports[k].non_finite_out, 0u);
  }
  EXPECT_EQ(reports[1].stages[2].stage, "half");
  EXPECT_GT(denoiser.memory_bytes(), before);
}

TEST_F(Door, ARefusedFrameLeavesHistoryUntouched) {
  Denoiser denoiser(config), undisturbed(config);
  filtered(denoiser, 0);
  filtered(undisturbed, 0);
  Camera& camera = scene.frames[1].camera;
  const Camera usable = std::exchange(camera, {.view_from_world = glm::dmat4(0)});
  PlaneSet results;
  EXPECT_THROW(denoiser.filter(scene.frames[1], results), InputError);
  camera = usable;
  EXPECT_EQ(difference(filtered(denoiser, 1), filtered(undisturbed, 1)), 0.0);
}

TEST_F(Door, ValuesThatCannotBeUsedAreRepairedAndCountedAlike) {
  const float bad[] = {NAN, INFINITY, -1.0f, 1e20f};
  for (Frame& frame : scene.frames) {
    int k = 0;
    for (Plane& plane : frame.planes)
      for (int c = 0; c < plane.channels() && !plane.is_uint(); ++c)
        for (int n = 0; n < 4; ++n, ++k)
          plane.channel(c).at((7 * k) % plane.width(), (3 * k) % plane.height()) = bad[n];
  }
  const auto repairs = [&](const char* preset) {
    config.preset = preset;
    Denoiser denoiser(config);
    for (std::size_t k = 0; k < scene.frames.size(); ++k) filtered(denoiser, k);
    std::string text;
    for (const RepairCount& count : reports.back().repaired)
      text += plane_name(count.plane) + " " + std::to_string(count.values) + "\n";
    EXPECT_EQ(reports.back().non_finite_out, 0u);
    return text;
  };
  const std::string by_oracle = repairs("reference");
  EXPECT_EQ(repairs("balanced"), by_oracle);
  EXPECT_NE(by_oracle.find("indirect"), std::string::npos);
}

}  // namespace
}  // namespace holdfast
