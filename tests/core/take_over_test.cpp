#include "core/denoiser/take_over.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/core/denoiser_world.h"
#include "tests/core/expect_input_error.h"
#include "tests/core/preset_world.h"

namespace holdfast {
namespace {

/// Without the client's motion vectors: cameras and transforms tell the motion.
DenoiserConfig config_of(const std::string& preset, int width = 37, int height = 29) {
  DenoiserConfig config = test::config_of(preset, width, height);
  std::erase(config.planes, PlaneId{PlaneKind::kMotion, {}});
  return config;
}

/// A wall whose reflections and indirect light are noise around 0.5, under a camera that moves.
Frame noise_on_a_wall(const DenoiserConfig& config, int index) {
  Frame frame = test::noisy_frame(config, index);
  test::fill(frame.planes.find(test::kDepthPlane)->channel(0), 5.0f);
  frame.objects.clear();
  Plane& ids = *frame.planes.find(test::kIdPlane);
  for (int y = 0; y < config.height; ++y)
    for (int x = 0; x < config.width; ++x) ids.ids().at(x, y) = 1;
  return frame;
}

double rms_around(const Plane& plane, double mean) {
  double sum = 0;
  for (int y = 0; y < plane.height(); ++y)
    for (int x = 0; x < plane.width(); ++x)
      sum += std::pow(static_cast<double>(plane.channel(1).at(x, y)) - mean, 2);
  return std::sqrt(sum / plane.width() / plane.height());
}

void expect_finite(const PlaneSet& planes, const std::string& where) {
  for (const Plane& plane : planes)
    for (int c = 0; !plane.is_uint() && c < plane.channels(); ++c)
      for (int y = 0; y < plane.height(); ++y)
        for (int x = 0; x < plane.width(); ++x)
          ASSERT_TRUE(std::isfinite(plane.channel(c).at(x, y)))
              << where << ' ' << plane_name(plane.id());
}

void run(Denoiser& denoiser, int first, int count) {
  for (int i = first; i < first + count; ++i)
    test::filtered(denoiser, noise_on_a_wall(denoiser.config(), i));
}

TEST(TakeOver, OfAnotherSizeIsBetterThanAFreshStartAndNearASessionThatAlwaysHadThatSize) {
  for (const std::string& preset : kernel_preset_names())
    for (const auto& [width, height] : {std::pair{74, 58}, {37, 29}, {50, 44}}) {
      Denoiser before(config_of(preset, 48, 40));
      run(before, 0, 12);
      DenoiserConfig config = config_of(preset, width, height);
      Denoiser after(config, before), fresh(config), always(config);
      run(always, 0, 12);
      PlaneSet kept, anew;
      const Frame frame = noise_on_a_wall(config, 12);
      const FrameReport report = after.filter(frame, kept);
      fresh.filter(frame, anew);
      const PlaneSet best = test::filtered(always, frame);
      EXPECT_FALSE(report.history_reset);
      EXPECT_GT(report.mean_history_frames, 1.5) << "a fresh start has 1";
      for (const PlaneId id : {test::kGlossyPlane, test::kIndirectPlane}) {
        const double error = rms_around(kept.at(id), 0.5);
        const std::string where = preset + ' ' + std::to_string(width) + ' ' + plane_name(id);
        // At twice the pixels a quarter of the samples count.
        EXPECT_LT(error, 0.95 * rms_around(anew.at(id), 0.5)) << where;
        EXPECT_LT(error, 1.7 * rms_around(best.at(id), 0.5)) << where;
      }
    }
}

TEST(TakeOver, OfTheSameChoicesGoesOnAsIfNothingHadHappened) {
  const DenoiserConfig config = config_of("balanced");
  DenoiserConfig without_cones = config;
  without_cones.indirect_basis = "irradiance";  // cones start anew
  Denoiser one(without_cones);
  run(one, 0, 5);
  Denoiser other(without_cones, one);
  PlaneSet a, b;
  const Frame frame = noise_on_a_wall(config, 5);
  one.filter(frame, a);
  other.filter(frame, b);
  EXPECT_LT(test::largest_difference(a, b), 1e-4);
}

TEST(TakeOver, LeavesTheDenoiserBeforeAsItWas) {
  const DenoiserConfig config = config_of("balanced");
  Denoiser one(config), untouched(config);
  run(one, 0, 3);
  run(untouched, 0, 3);
  Denoiser other(config_of("fast", 64, 20), one);
  run(other, 3, 1);
  const Frame frame = noise_on_a_wall(config, 3);
  EXPECT_TRUE(test::same_bits(test::filtered(one, frame), test::filtered(untouched, frame)));
}

TEST(TakeOver, GoesFromEveryRecipeToEveryOtherWithFiniteResults) {
  for (const std::string& from : recipe_names())
    for (const std::string& to : recipe_names()) {
      DenoiserConfig config = config_of("balanced", 24, 18);
      config.recipe = from;
      Denoiser before(config);
      for (int i = 0; i < 3; ++i) test::filtered(before, test::noisy_frame(config, i));
      config = config_of("fast", 31, 17);
      config.recipe = to;
      Denoiser after(config, before);
      for (int i = 3; i < 5; ++i) {
        PlaneSet results;
        const FrameReport report = after.filter(test::noisy_frame(config, i), results);
        expect_finite(results, from + " to " + to);
        EXPECT_EQ(report.history_reset, (from == "spatial" && i == 3) || to == "spatial");
        EXPECT_EQ(report.non_finite_out, 0u);
      }
    }
}

TEST(TakeOver, KeepsWhatAnotherRecipeHasLearnt) {
  for (const char* to : {"traditional", "svgf", "paper"}) {
    DenoiserConfig config = config_of("balanced", 48, 40);
    Denoiser before(config);
    run(before, 0, 12);
    config.recipe = to;
    Denoiser after(config, before), fresh(config);
    const Frame frame = noise_on_a_wall(config, 12);
    const PlaneSet kept = test::filtered(after, frame), anew = test::filtered(fresh, frame);
    for (const PlaneId id : {test::kGlossyPlane, test::kIndirectPlane})
      EXPECT_LT(rms_around(kept.at(id), 0.5), 0.99 * rms_around(anew.at(id), 0.5))
          << to << ' ' << plane_name(id);
  }
}

TEST(TakeOver, StartsAnewFromAndToReference) {
  for (const auto& [from, to] : {std::pair{"reference", "fast"}, {"fast", "reference"}}) {
    Denoiser before(config_of(from, 12, 9));
    run(before, 0, 2);
    Denoiser after(config_of(to, 12, 9), before);
    PlaneSet results;
    EXPECT_TRUE(after.filter(noise_on_a_wall(after.config(), 2), results).history_reset);
  }
}

TEST(TakeOver, KeepsIndicesAndTransforms) {
  Denoiser before(config_of("fast", 24, 18));
  run(before, 0, 3);
  Denoiser after(config_of("fast", 30, 18), before);
  EXPECT_THROW(run(after, 2, 1), InputError);
  PlaneSet results;
  Frame frame = noise_on_a_wall(after.config(), 3);
  frame.lights.clear();  // they have not moved
  EXPECT_FALSE(after.filter(frame, results).history_reset);
}

TEST(TakeOver, BeforeTheFirstFrameIsAFreshStart) {
  const DenoiserConfig config = config_of("balanced", 30, 20);
  Denoiser before(config_of("balanced")), fresh(config);
  Denoiser after(config, before);
  const Frame frame = noise_on_a_wall(config, 0);
  EXPECT_TRUE(test::same_bits(test::filtered(after, frame), test::filtered(fresh, frame)));
}

TEST(TakeOver, OfOtherLightsOrPlanesIsRefused) {
  const Denoiser before(config_of("fast"));
  DenoiserConfig config = config_of("fast");
  config.lights[0].width *= 2;
  test::expect_input_error([&] { Denoiser after(config, before); }, "lights and planes",
                           "must be those of the denoiser before", "others");
}

// Each object keeps its own light across its silhouette, at sizes of no common multiple.
TEST(TakeOver, MixesNoTwoObjects) {
  const auto frame_of = [](const DenoiserConfig& config, int index) {
    Frame frame = test::noisy_frame(config, index);
    frame.camera = test::perspective_camera(config.width, config.height);
    frame.objects[2] = glm::dmat4(1);
    const Plane& ids = frame.planes.at(test::kIdPlane);
    Plane& indirect = *frame.planes.find(test::kIndirectPlane);
    for (int c = 0; c < 3; ++c)
      for (int y = 0; y < config.height; ++y)
        for (int x = 0; x < config.width; ++x)
          indirect.channel(c).at(x, y) = ids.ids().at(x, y) == 2 ? 100.0f : 1.0f;
    return frame;
  };
  Denoiser before(config_of("balanced", 148, 116));
  for (int i = 0; i < 4; ++i) test::filtered(before, frame_of(before.config(), i));
  const DenoiserConfig config = config_of("balanced", 111, 131);
  Denoiser after(config, before);
  const Frame frame = frame_of(config, 4);
  const PlaneSet out = test::filtered(after, frame);
  for (int y = 4; y < config.height; ++y)
    for (int x = 0; x < config.width; ++x) {
      const bool box = frame.planes.at(test::kIdPlane).ids().at(x, y) == 2;
      ASSERT_NEAR(out.at(test::kIndirectPlane).channel(0).at(x, y), box ? 100.0f : 1.0f,
                  box ? 1.0f : 0.01f)
          << x << ", " << y;
    }
}

}  // namespace
}  // namespace holdfast
