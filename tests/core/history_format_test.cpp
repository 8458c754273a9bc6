// How histories are kept, as a whole denoiser shows it.

#include <cmath>
#include <utility>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "core/denoiser/plan.h"
#include "tests/core/denoiser_world.h"
#include "tests/core/expect_input_error.h"
#include "tests/core/isa_guard.h"
#include "tests/core/preset_world.h"

namespace holdfast {
namespace {

using test::config_of;

/// The same frame time after time: nothing moves, but for what `index` draws.
Frame still_frame(const DenoiserConfig& config, std::int64_t index) {
  Frame frame = test::noisy_frame(config, 0);
  Frame drawn = test::noisy_frame(config, index, 5);
  for (const PlaneId id :
       {test::kGlossyPlane, test::kIndirectPlane, test::of_light(PlaneKind::kVisibility),
        PlaneId{PlaneKind::kIndirectDirection, {}}})
    if (Plane* plane = drawn.planes.find(id)) *frame.planes.find(id) = std::move(*plane);
  frame.index = index;
  return frame;
}

struct Means {
  double mean = 0, rms = 0;
};

/// Of a minus b, over all channels; and the mean of b.
Means differences(const PlaneSet& a, const PlaneSet& b, PlaneId id) {
  const Plane &of_a = a.at(id), &of_b = b.at(id);
  Means sums;
  const double values = 1.0 * of_a.channels() * of_a.width() * of_a.height();
  double square = 0;
  for (int c = 0; c < of_a.channels(); ++c)
    for (int y = 0; y < of_a.height(); ++y)
      for (int x = 0; x < of_a.width(); ++x) {
        const double base = double{of_b.channel(c).at(x, y)};
        const double off = double{of_a.channel(c).at(x, y)} - base;
        sums.mean += base / values;
        square += off * off / values;
      }
  sums.rms = std::sqrt(square);
  return sums;
}

DenoiserConfig packed_config(int width = 37, int height = 29) {
  DenoiserConfig config = config_of("balanced", width, height);
  config.history = "f16";
  return config;
}

constexpr std::size_t kMostImages =
    20;  // that a session here keeps: guides of two sizes, 3 of each component and its cones

/// What a pixel takes: what twice the rows take more, so that what images have before them is out.
double kept_bytes(DenoiserConfig config, const std::string& history) {
  config.history = history;
  const double pixels = config.width * config.height;
  const std::size_t bytes = Denoiser(config).history_bytes();
  config.height *= 2;
  const std::size_t of_twice = Denoiser(config).history_bytes();
  EXPECT_LE(2 * bytes - of_twice, kMostImages * 64) << "a cache line before each image, no more";
  return static_cast<double>(of_twice - bytes) / pixels;
}

TEST(HistoryFormat, IsOfFloatsUnlessOtherwiseAskedFor) {
  const auto format = [](const std::string& preset, const std::string& history) {
    DenoiserConfig config = config_of(preset);
    config.history = history;
    return Plan::make(config).history_format;
  };
  for (const char* preset : {"fast", "balanced", "accurate"}) {
    EXPECT_EQ(format(preset, ""), HistoryFormat::kFloat);
    EXPECT_EQ(format(preset, "f16"), HistoryFormat::kPacked);
  }
  DenoiserConfig config = config_of("balanced");
  config.history = "f8";
  test::expect_input_error([&] { Denoiser{config}; }, "history", "f16 or f32", "'f8'");
}

TEST(HistoryFormat, MomentsOfTheLuminanceStayFloats) {
  DenoiserConfig config = config_of("balanced");
  for (const char* recipe : {"svgf", "asvgf"}) {
    config.recipe = recipe;
    config.history = "f16";
    EXPECT_EQ(Plan::make(config).history_format, HistoryFormat::kFloat);
  }
  config.recipe = "spatial";
  EXPECT_EQ(Plan::make(config).history_format, HistoryFormat::kNone);
  EXPECT_EQ(Denoiser(config).history_bytes(), 0u);
}

// Rows have no padding at 64 pixels: what a pixel takes is what its channels take, and a byte for
// each block's exponent.
TEST(HistoryFormat, EveryKindOfSceneKeepsTheBytesThatItsChannelsTake) {
  constexpr double kGuides = 4 + 12 + 4, kPacked = 4 + 4 + 4;
  constexpr double kResults = 4, kColours = 12;  // of components that may rest: floats alone
  DenoiserConfig shadows = test::shadow_config(64, 64);
  EXPECT_NEAR(kept_bytes(shadows, "f16"), kPacked + 2 + 1, 1.0);
  EXPECT_NEAR(kept_bytes(shadows, "f32"), kGuides + 8 + kResults, 1e-9);
  DenoiserConfig all = test::full_config(64, 64);
  const double visibilities = 2 * (2 + 1), radiances = 2 * (6 + 1);
  EXPECT_NEAR(kept_bytes(all, "f16"), kPacked + visibilities + radiances, 1.0);
  const double floats = kGuides + 2 * (8 + kResults) + 2 * (16 + kColours);
  EXPECT_NEAR(kept_bytes(all, "f32"), floats, 1e-9);
  all.planes.push_back({PlaneKind::kIndirectDirection, {}});
  EXPECT_NEAR(kept_bytes(all, "f16"), kPacked + visibilities + radiances + 14, 1.3);
  EXPECT_NEAR(kept_bytes(all, "f32"), floats + 56, 1e-9);
  all.indirect_basis = "cones";
  EXPECT_NEAR(kept_bytes(all, "f16"), kPacked + visibilities + radiances + 24, 1.6);
  all.half_resolution = {"indirect"};
  EXPECT_NEAR(kept_bytes(all, "f16"), 1.25 * kPacked + visibilities + 7 + (7 + 24) / 4.0, 2.0);
}

TEST(HistoryFormat, ThePlansTextSaysWhatIsKept) {
  const DenoiserConfig config = packed_config(64, 64);
  const std::string text = Denoiser(config).plan_text();
  EXPECT_NE(text.find("kept of glossy as f16: 7."), std::string::npos) << text;
  EXPECT_NE(text.find("kept cones of indirect as f16: 14."), std::string::npos) << text;
  EXPECT_NE(text.find("all that is kept from frame to frame: "), std::string::npos) << text;
}

/// Squares of what a plane is off its mean in the end, and its mean.
struct Errors {
  double square = 0, mean = 0;

  void add(const Plane& plane, int frames) {
    const double values = 1.0 * plane.channels() * plane.width() * (plane.height() - kSkyRows);
    for (int c = 0; c < plane.channels(); ++c)
      for (int y = kSkyRows; y < plane.height(); ++y)
        for (int x = 0; x < plane.width(); ++x) {
          const double value = double{plane.channel(c).at(x, y)};
          square += (value - 0.5) * (value - 0.5) / (values * frames);
          mean += value / (values * frames);
        }
  }
  static constexpr int kSkyRows = 4;
};

// Samples of mean 0.5, for longer than the history remembers: the mean of 64 would stand still
// where a sample changes it by less than half a step of a half.
TEST(HistoryFormat, AtRestErrorsAreThoseOfFloats) {
  DenoiserConfig config = packed_config(18, 14);
  // Cones ask for directions of cosine density, which these are not.
  std::erase(config.planes, PlaneId{PlaneKind::kIndirectDirection, {}});
  DenoiserConfig exact = config;
  exact.history = "f32";
  Denoiser packed(config), floats(exact);
  const PlaneId ids[] = {test::kGlossyPlane, test::kIndirectPlane,
                         test::of_light(PlaneKind::kVisibility)};
  constexpr int kFrames = 240, kJudged = 160;
  Errors of_packed[3], of_floats[3];
  for (int index = 0; index < kFrames; ++index) {
    const Frame frame = still_frame(config, index);
    const PlaneSet a = test::filtered(packed, frame), b = test::filtered(floats, frame);
    for (int k = 0; k < 3 && index >= kFrames - kJudged; ++k) {
      of_packed[k].add(a.at(ids[k]), kJudged);
      of_floats[k].add(b.at(ids[k]), kJudged);
    }
  }
  for (int k = 0; k < 3; ++k) {
    EXPECT_LT(of_packed[k].square, 1.03 * of_floats[k].square) << plane_name(ids[k]);
    EXPECT_NEAR(of_packed[k].mean, of_floats[k].mean, 1e-3) << plane_name(ids[k]);
  }
}

TEST(HistoryFormat, NothingOfWhatARoomHeldBeforeComesThrough) {
  for (const char* history : {"f16", "f32"})
    for (const std::string& recipe : recipe_names()) {
      DenoiserConfig config = config_of("balanced");
      config.history = history;
      config.recipe = recipe;
      Denoiser used(config), fresh(config);
      for (int index = 0; index < 3; ++index) {
        Frame frame = test::noisy_frame(config, index, 9);
        for (const PlaneId id : {test::kIndirectPlane, test::kGlossyPlane})
          for (int c = 0; c < 3; ++c) test::fill(frame.planes.find(id)->channel(c), 1e14f);
        test::filtered(used, frame);
      }
      for (int index = 3; index < 6; ++index) {
        Frame frame = test::noisy_frame(config, index);
        frame.cut = index == 3;
        const PlaneSet expected = test::filtered(fresh, frame);
        ASSERT_TRUE(test::same_bits(test::filtered(used, frame), expected))
            << recipe << ' ' << history << ' ' << index;
      }
    }
}

PlaneSet last_of(const DenoiserConfig& config, int frames, float scale = 1.0f) {
  Denoiser denoiser(config);
  PlaneSet results;
  for (int index = 0; index < frames; ++index) {
    Frame frame = test::noisy_frame(config, index);
    for (const PlaneId id : {test::kIndirectPlane, test::kGlossyPlane}) {
      Plane& plane = *frame.planes.find(id);
      for (int c = 0; c < 3; ++c)
        for (int y = 0; y < plane.height(); ++y)
          for (int x = 0; x < plane.width(); ++x) plane.channel(c).at(x, y) *= scale;
    }
    denoiser.filter(frame, results);
  }
  return results;
}

TEST(HistoryFormat, TheSameBitsOnAnyNumberOfThreads) {
  PlaneSet results[2];
  for (const int threads : {1, 4}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(threads));
    results[threads == 1 ? 0 : 1] = last_of(packed_config(70, 40), 5);
  }
  EXPECT_TRUE(test::same_bits(results[0], results[1]));
}

TEST(HistoryFormat, InstructionSetsDifferByFewRoundings) {
  const test::IsaGuard guard;
  const DenoiserConfig config = packed_config();
  select_isa(Isa::kScalar);
  const PlaneSet expected = last_of(config, 6);
  for (const Isa isa : available_isas()) {
    select_isa(isa);
    const PlaneSet results = last_of(config, 6);
    for (const PlaneId id : {test::kGlossyPlane, test::kIndirectPlane}) {
      const Means means = differences(results, expected, id);
      EXPECT_LT(means.rms, 1e-4 * means.mean) << isa_name(isa) << ' ' << plane_name(id);
    }
  }
}

// Radiance has no scale that halves could not hold.
TEST(HistoryFormat, RadianceBeyondTheGreatestHalfIsKeptAsWellAsAnyOther) {
  const DenoiserConfig config = packed_config();
  const PlaneSet expected = last_of(config, 8);
  for (const int exponent : {-24, 20, 36}) {
    const float scale = std::ldexp(1.0f, exponent);
    PlaneSet results = last_of(config, 8, scale);
    for (const PlaneId id : {test::kGlossyPlane, test::kIndirectPlane}) {
      Plane& plane = *results.find(id);
      for (int c = 0; c < 3; ++c)
        for (int y = 0; y < plane.height(); ++y)
          for (int x = 0; x < plane.width(); ++x) plane.channel(c).at(x, y) /= scale;
      const Means means = differences(results, expected, id);
      EXPECT_LT(means.rms, 1e-5 * means.mean) << exponent << ' ' << plane_name(id);
    }
  }
}

}  // namespace
}  // namespace holdfast
