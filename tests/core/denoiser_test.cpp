#include "core/denoiser/denoiser.h"

#include <algorithm>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "core/kernels/isa.h"
#include "tests/core/denoiser_world.h"

namespace holdfast {
namespace {

using test::filtered;
using test::full_config;
using test::noisy_frame;
using test::same_bits;

std::vector<PlaneSet> run_sequence(const DenoiserConfig& config, int frames) {
  Denoiser denoiser(config);
  std::vector<PlaneSet> results;
  for (int index = 0; index < frames; ++index)
    results.push_back(filtered(denoiser, noisy_frame(config, index)));
  return results;
}

/// A still scene without noise: a wall, and a box of its own colour that faces another way.
Frame noise_free_frame(const DenoiserConfig& config, std::int64_t index, float box_scale) {
  Frame frame = noisy_frame(config, 0);
  frame.index = index;
  const auto depth = frame.planes.at(test::kDepthPlane).channel(0);
  for (Plane& plane : frame.planes) {
    const PlaneKind kind = plane.id().kind;
    const bool signal = kind == PlaneKind::kVisibility || kind == PlaneKind::kGlossy ||
                        kind == PlaneKind::kIndirect;
    if (!signal && kind != PlaneKind::kNormal) continue;
    for (int c = 0; c < plane.channels(); ++c)
      for (int y = 0; y < plane.height(); ++y)
        for (int x = 0; x < plane.width(); ++x) {
          const bool box = depth.at(x, y) == 3.0f;
          plane.channel(c).at(x, y) = !signal
                                          ? (c == (box ? 0 : 2) ? 1.0f : 0.0f)
                                          : (box ? box_scale : 1.0f) / static_cast<float>(c + 1);
        }
  }
  return frame;
}

// Filters of normalised weights: each of some ten means rounds a few times. Halves have steps of
// 1/1024, a few of which are left of a mean over pixels.
void expect_unchanged(const std::string& recipe, float box_scale, const char* history) {
  const float tolerance = history == std::string("f32") ? 1e-5f : 2e-4f;
  DenoiserConfig config = full_config();
  config.recipe = recipe;
  config.history = history;
  Denoiser denoiser(config);
  for (int index = 0; index < 6; ++index) {
    const Frame frame = noise_free_frame(config, index, box_scale);
    const PlaneSet results = filtered(denoiser, frame);
    for (const Plane& plane : results) {
      const Plane* in = frame.planes.find(plane.id());
      if (in == nullptr) continue;  // the composite
      for (int c = 0; c < plane.channels(); ++c)
        for (int y = 0; y < plane.height(); ++y)
          for (int x = 0; x < plane.width(); ++x)
            ASSERT_NEAR(plane.channel(c).at(x, y), in->channel(c).at(x, y), tolerance)
                << recipe << " " << history << " " << plane_name(plane.id()) << " " << x << ", "
                << y;
    }
  }
}

TEST(Denoiser, ReturnsStaticNoiseFreeInputUnchangedUnderEveryRecipe) {
  for (const std::string& recipe : recipe_names())
    for (const char* history : {"f16", "f32"}) expect_unchanged(recipe, 1.0f, history);
}

// A clamp to 3x3 pixels looks across the edge by design.
TEST(Denoiser, KeepsTheColoursOfSurfacesThatMeetApart) {
  for (const std::string recipe : {"spatial", "traditional", "svgf", "reliable"})
    for (const char* history : {"f16", "f32"}) expect_unchanged(recipe, 0.3f, history);
}

TEST(Denoiser, ReducesTheNoiseOfAStillSceneUnderEveryRecipe) {
  for (const std::string& recipe : recipe_names()) {
    DenoiserConfig config = full_config();
    config.recipe = recipe;
    Denoiser denoiser(config);
    double noisy = 0, clean = 0;
    for (int index = 0; index < 8; ++index) {
      Frame frame = noisy_frame(config, index);
      frame.camera = noisy_frame(config, 0).camera;
      frame.objects.clear();
      const PlaneSet results = filtered(denoiser, frame);
      if (index < 7) continue;
      for (int y = 3; y < config.height; ++y)
        for (int x = 0; x < config.width; ++x) {
          const double in = frame.planes.at(test::kGlossyPlane).channel(1).at(x, y);
          const double out = results.at(test::kGlossyPlane).channel(1).at(x, y);
          noisy += (in - 0.5) * (in - 0.5);
          clean += (out - 0.5) * (out - 0.5);
        }
    }
    EXPECT_LT(clean, 0.1 * noisy) << recipe;
  }
}

TEST(Denoiser, PassesSkyThrough) {
  for (const std::string& recipe : recipe_names()) {
    DenoiserConfig config = full_config();
    config.recipe = recipe;
    Denoiser denoiser(config);
    for (int index = 0; index < 3; ++index) {
      const Frame frame = noisy_frame(config, index);
      const PlaneSet results = filtered(denoiser, frame);
      for (const PlaneId id : {test::of_light(PlaneKind::kVisibility), test::kIndirectPlane})
        for (int x = 0; x < config.width; ++x)
          ASSERT_EQ(results.at(id).channel(0).at(x, 1), frame.planes.at(id).channel(0).at(x, 1));
      for (int c = 0; c < 3; ++c)
        for (int x = 0; x < config.width; ++x)
          ASSERT_EQ(results.at(test::kCompositePlane).channel(c).at(x, 2),
                    frame.planes.at({PlaneKind::kEmission, {}}).channel(c).at(x, 2))
              << recipe;
    }
  }
}

TEST(Denoiser, RepeatedRunsAndAnyNumberOfThreadsGiveTheSameBits) {
  for (const std::string& recipe : recipe_names()) {
    DenoiserConfig config = full_config(65, 41);
    config.recipe = recipe;
    std::vector<PlaneSet> runs[3];
    for (const std::size_t threads : {1u, 2u, 2u}) {
      const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
      runs[runs[0].empty() ? 0 : (runs[1].empty() ? 1 : 2)] = run_sequence(config, 4);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      EXPECT_TRUE(same_bits(runs[0][k], runs[1][k])) << recipe << " 1 and 2 threads";
      EXPECT_TRUE(same_bits(runs[1][k], runs[2][k])) << recipe << " twice";
    }
  }
}

// Fused multiply-add rounds differently; weights and recursive history carry the difference on.
TEST(Denoiser, EveryInstructionSetAgreesWithThePortableOne) {
  const Isa before = selected_isa();
  for (const std::string& recipe : recipe_names()) {
    DenoiserConfig config = full_config();
    config.recipe = recipe;
    select_isa(Isa::kPortable);
    const auto expected = run_sequence(config, 4);
    for (const Isa isa : available_isas()) {
      select_isa(isa);
      const auto results = run_sequence(config, 4);
      for (std::size_t k = 0; k < 4; ++k)
        EXPECT_LE(test::largest_difference(results[k], expected[k]), 2e-4)
            << recipe << " " << isa_name(isa) << " frame " << k;
    }
  }
  select_isa(before);
}

TEST(Denoiser, CutStartsAnewAsAFreshDenoiserDoes) {
  for (const std::string& recipe : recipe_names()) {
    DenoiserConfig config = full_config();
    config.recipe = recipe;
    Denoiser used(config), fresh(config);
    for (int index = 0; index < 3; ++index) filtered(used, noisy_frame(config, index, 5));
    for (int index = 10; index < 14; ++index) {
      Frame frame = noisy_frame(config, index);
      frame.cut = index == 10;
      PlaneSet results;
      const FrameReport report = used.filter(frame, results);
      EXPECT_EQ(report.history_reset, index == 10 || recipe == "spatial");
      EXPECT_TRUE(same_bits(results, filtered(fresh, frame))) << recipe << " " << index;
    }
  }
}

TEST(Denoiser, ResetStartsAnewAsAFreshDenoiserDoes) {
  const DenoiserConfig config = full_config();
  Denoiser used(config), fresh(config);
  for (int index = 0; index < 3; ++index) filtered(used, noisy_frame(config, index, 5));
  used.reset();
  for (int index = 10; index < 13; ++index) {
    const Frame frame = noisy_frame(config, index);
    EXPECT_TRUE(same_bits(filtered(used, frame), filtered(fresh, frame))) << index;
  }
}

TEST(Denoiser, SpatialRecipeHasNoHistory) {
  DenoiserConfig config = full_config();
  config.recipe = "spatial";
  Denoiser used(config), fresh(config);
  for (int index = 0; index < 3; ++index) filtered(used, noisy_frame(config, index));
  PlaneSet results;
  const FrameReport report = used.filter(noisy_frame(config, 9), results);
  EXPECT_TRUE(same_bits(results, filtered(fresh, noisy_frame(config, 9))));
  EXPECT_TRUE(report.history_reset);
  EXPECT_EQ(report.mean_history_frames, 1.0);
}

TEST(Denoiser, HistoryGrowsAndIsReported) {
  const DenoiserConfig config = full_config();
  Denoiser denoiser(config);
  double last = 0;
  for (int index = 0; index < 5; ++index) {
    PlaneSet results;
    const FrameReport report = denoiser.filter(noisy_frame(config, index), results);
    EXPECT_EQ(report.index, index);
    EXPECT_GT(report.mean_history_frames, last);
    EXPECT_EQ(report.non_finite_out, 0u);
    last = report.mean_history_frames;
  }
}

TEST(Denoiser, ResultsAreThePlanesItAnnounces) {
  for (const bool debug : {false, true}) {
    DenoiserConfig config = full_config();
    config.debug_planes = debug;
    Denoiser denoiser(config);
    const PlaneSet results = filtered(denoiser, noisy_frame(config, 0));
    const auto announced = result_planes(config);
    ASSERT_EQ(results.size(), announced.size());
    auto it = announced.begin();
    for (const Plane& plane : results) EXPECT_EQ(plane_name(plane.id()), plane_name(*it++));
    EXPECT_EQ(announced.size(), debug ? 17u : 5u);
  }
}

TEST(Denoiser, DebugPlanesChangeNoResult) {
  for (const std::string& recipe : recipe_names()) {
    DenoiserConfig config = full_config(), with_debug = full_config();
    config.recipe = with_debug.recipe = recipe;
    with_debug.debug_planes = true;
    Denoiser plain(config), debugging(with_debug);
    for (int index = 0; index < 3; ++index) {
      const Frame frame = noisy_frame(config, index);
      PlaneSet results = filtered(debugging, frame);
      for (const PlaneId id : result_planes(with_debug))
        if (id.kind >= PlaneKind::kDebugMotion) results.remove(id);
      EXPECT_TRUE(same_bits(filtered(plain, frame), results)) << recipe;
    }
  }
}

TEST(Denoiser, OneByOneAndNarrowFramesAreFiltered) {
  for (const auto& [width, height] : {std::pair{1, 1}, {1, 9}, {33, 1}, {2, 3}})
    for (const std::string& recipe : recipe_names()) {
      DenoiserConfig config = full_config(width, height);
      config.recipe = recipe;
      Denoiser denoiser(config);
      for (int index = 0; index < 3; ++index) {
        Frame frame = noisy_frame(config, index);
        test::fill(frame.planes.find(test::kDepthPlane)->channel(0), 5.0f);
        const PlaneSet results = filtered(denoiser, frame);
        EXPECT_LE(test::largest_difference(results, results), 0.0) << recipe;
      }
    }
}

}  // namespace
}  // namespace holdfast
