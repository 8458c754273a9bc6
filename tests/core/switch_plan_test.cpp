#include "core/denoiser/switch_plan.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/core/denoiser_world.h"
#include "tests/core/expect_input_error.h"
#include "tests/core/preset_world.h"

namespace holdfast {
namespace {

using test::config_of;

/// A wall at rest whose reflections and indirect light are noise around 0.5.
Frame frame_at_rest(const DenoiserConfig& config, int index) {
  Frame frame = test::noisy_frame(config, index);
  frame.camera = test::perspective_camera(config.width, config.height);
  frame.objects[2] = glm::dmat4(1);
  for (const Light& light : config.lights)
    frame.lights[light.id] = glm::translate(glm::dmat4(1), {0, 0.5, -1});
  test::fill(frame.planes.find(test::kDepthPlane)->channel(0), 5.0f);
  Plane& ids = *frame.planes.find(test::kIdPlane);
  for (int y = 0; y < config.height; ++y)
    for (int x = 0; x < config.width; ++x) ids.ids().at(x, y) = 1;
  for (int c = 0; c < 2; ++c)
    test::fill(frame.planes.find({PlaneKind::kMotion, {}})->channel(c), 0.0f);
  return frame;
}

double rms_around(const Plane& plane, double mean) {
  double sum = 0;
  for (int y = 0; y < plane.height(); ++y)
    for (int x = 0; x < plane.width(); ++x)
      sum += std::pow(static_cast<double>(plane.channel(1).at(x, y)) - mean, 2);
  return std::sqrt(sum / plane.width() / plane.height());
}

TEST(SetPreset, RefusesAnUnknownNameAndThenChangesNothing) {
  const DenoiserConfig config = config_of("balanced");
  Denoiser denoiser(config), other(config);
  test::expect_input_error([&] { denoiser.set_preset("slow"); }, "preset",
                           "fast, balanced, accurate", "'slow'");
  const Frame frame = test::noisy_frame(config, 0);
  EXPECT_TRUE(test::same_bits(test::filtered(denoiser, frame), test::filtered(other, frame)));
}

TEST(SetPreset, IsRefusedToAndFromReferenceWhichSharesNoHistory) {
  const DenoiserConfig config = config_of("balanced");
  Denoiser denoiser(config), untouched(config), reference(config_of("reference"));
  test::expect_input_error([&] { denoiser.set_preset("reference"); }, "change of preset",
                           "must not be to or from reference", "'balanced' to 'reference'");
  test::expect_input_error([&] { reference.set_preset("fast"); }, "change of preset",
                           "must not be to or from reference", "'reference' to 'fast'");
  EXPECT_NO_THROW(reference.set_preset("reference"));
  const Frame frame = test::noisy_frame(config, 0);
  EXPECT_TRUE(test::same_bits(test::filtered(denoiser, frame), test::filtered(untouched, frame)));
}

TEST(SetPreset, HoldsFromTheNextFrameOnAndIsReported) {
  const DenoiserConfig config = config_of("balanced");
  Denoiser denoiser(config);
  PlaneSet results;
  EXPECT_EQ(denoiser.filter(test::noisy_frame(config, 0), results).preset, "balanced");
  denoiser.set_preset("fast");
  EXPECT_EQ(denoiser.config().preset, "balanced");
  EXPECT_THROW(denoiser.filter(test::noisy_frame(config, 0), results), InputError);
  EXPECT_EQ(denoiser.config().preset, "balanced") << "the frame was refused";
  const FrameReport report = denoiser.filter(test::noisy_frame(config, 1), results);
  EXPECT_EQ(report.preset, "fast");
  EXPECT_EQ(denoiser.config().preset, "fast");
  EXPECT_FALSE(report.history_reset);
  EXPECT_EQ(report.stages.front().stage, "preset");
  denoiser.set_preset("accurate");
  denoiser.set_preset("fast");
  EXPECT_EQ(denoiser.filter(test::noisy_frame(config, 2), results).stages.front().stage, "guides");
}

TEST(SetPreset, BeforeTheFirstFrameIsAsIfMadeWithIt) {
  for (const std::string& from : kernel_preset_names())
    for (const std::string& to : kernel_preset_names()) {
      const DenoiserConfig config = config_of(to);
      Denoiser made(config), changed(config_of(from));
      changed.set_preset(to);
      for (int index = 0; index < 3; ++index) {
        const Frame frame = test::noisy_frame(config, index);
        ASSERT_TRUE(test::same_bits(test::filtered(made, frame), test::filtered(changed, frame)))
            << from << " to " << to;
      }
    }
}

TEST(SetPreset, AnotherKernelTouchesNoHistory) {
  DenoiserConfig config = test::shadow_config();
  config.half_resolution = {"none"};
  Denoiser steady(config), switched(config);
  for (int index = 0; index < 6; ++index) {
    switched.set_preset(index % 3 == 1 ? "fast" : "accurate");
    const Frame frame = test::noisy_frame(config, index);
    const auto same =
        test::same_bits(test::filtered(steady, frame), test::filtered(switched, frame));
    EXPECT_EQ(static_cast<bool>(same), index % 3 != 1) << index;
  }
}

TEST(SetPreset, TheSameSequenceGivesTheSameBitsForEveryRecipe) {
  const char* sequence[] = {"accurate", "fast", "fast", "balanced", "accurate", "fast", "balanced"};
  for (const std::string& recipe : recipe_names()) {
    DenoiserConfig config = config_of("balanced");
    config.recipe = recipe;
    config.debug_planes = true;
    Denoiser a(config), b(config);
    for (int index = 0; index < 7; ++index) {
      a.set_preset(sequence[index]);
      b.set_preset("fast");
      b.set_preset(sequence[index]);
      const Frame frame = test::noisy_frame(config, index);
      const PlaneSet results = test::filtered(a, frame);
      ASSERT_TRUE(test::same_bits(results, test::filtered(b, frame))) << recipe << ' ' << index;
      ASSERT_LT(test::largest_difference(results, results), 1.0) << recipe << ' ' << index;
    }
  }
}

TEST(SetPreset, HoldsTheMemoryOfADenoiserMadeWithThatPreset) {
  const DenoiserConfig config = config_of("balanced", 70, 50);
  Denoiser denoiser(config);
  int index = 0;
  for (const char* preset : {"fast", "accurate", "balanced", "fast", "balanced"}) {
    denoiser.set_preset(preset);
    test::filtered(denoiser, test::noisy_frame(config, index++));
    EXPECT_EQ(denoiser.memory_bytes(), Denoiser(config_of(preset, 70, 50)).memory_bytes())
        << preset;
    EXPECT_EQ(denoiser.plan_text(), Denoiser(config_of(preset, 70, 50)).plan_text());
  }
}

TEST(SetPreset, AConstantImageStaysAFixedPointWhateverIsSwitched) {
  for (const auto& [width, height] : {std::pair{1, 1}, {1, 7}, {5, 3}, {20, 11}}) {
    const DenoiserConfig config = config_of("balanced", width, height);
    Denoiser denoiser(config);
    for (int index = 0; index < 9; ++index) {
      Frame frame = test::noisy_frame(config, index);
      for (const PlaneId id : {test::kIndirectPlane, test::kGlossyPlane})
        for (int c = 0; c < 3; ++c) test::fill(frame.planes.find(id)->channel(c), 0.5f);
      denoiser.set_preset(kernel_preset_names()[static_cast<std::size_t>(index * index % 3)]);
      const PlaneSet out = test::filtered(denoiser, frame);
      for (const PlaneId id : {test::kIndirectPlane, test::kGlossyPlane})
        for (int y = 0; y < height; ++y)
          for (int x = 0; x < width; ++x)
            ASSERT_NEAR(out.at(id).channel(1).at(x, y), 0.5f, 1e-4f)
                << plane_name(id) << ' ' << width << 'x' << height << " frame " << index;
    }
  }
}

// The error right after a switch is about that of the preset which has been there all along, and
// far from that of a new start.
TEST(SetPreset, HistoryComesAlongBetweenAllPresets) {
  for (const std::string& from : kernel_preset_names())
    for (const std::string& to : kernel_preset_names()) {
      if (from == to) continue;
      const DenoiserConfig config = config_of(to, 64, 48);
      Denoiser steady(config), anew(config), switched(config_of(from, 64, 48));
      PlaneSet planes[3];
      FrameReport reports[3];
      for (int index = 0; index < 16; ++index) {
        const bool last = index == 15;
        if (last) switched.set_preset(to);
        if (last) anew.reset();
        const Frame frame = frame_at_rest(config, index);
        reports[0] = steady.filter(frame, planes[0]);
        reports[1] = switched.filter(frame, planes[1]);
        reports[2] = anew.filter(frame, planes[2]);
      }
      EXPECT_NEAR(reports[1].mean_history_frames, reports[0].mean_history_frames, 3.0)
          << from << " to " << to;
      for (const PlaneId id : {test::kIndirectPlane, test::kGlossyPlane}) {
        const double steadily = rms_around(planes[0].at(id), 0.5);
        const double after = rms_around(planes[1].at(id), 0.5);
        EXPECT_LT(after, 1.5 * steadily) << plane_name(id) << ' ' << from << " to " << to;
        EXPECT_LT(after, 0.6 * rms_around(planes[2].at(id), 0.5))
            << plane_name(id) << ' ' << from << " to " << to;
      }
    }
}

}  // namespace
}  // namespace holdfast
