#include <algorithm>
#include <bit>
#include <functional>

#include <gtest/gtest.h>

#include "core/denoiser/denoiser.h"
#include "core/denoiser/frame_input.h"
#include "tests/core/denoiser_world.h"
#include "tests/core/expect_input_error.h"

namespace holdfast {
namespace {

using test::expect_input_error;
using test::full_config;
using test::noisy_frame;

TEST(DenoiserConfig, ThatBreaksARuleIsRejectedByName) {
  const auto expect = [](const std::function<void(DenoiserConfig&)>& spoil, const char* subject,
                         const char* rule, const char* value) {
    DenoiserConfig config = full_config();
    spoil(config);
    expect_input_error([&] { Denoiser denoiser(config); }, subject, rule, value);
  };
  expect([](DenoiserConfig& c) { c.width = 0; }, "frame size", "1..16384", "0x29");
  expect([](DenoiserConfig& c) { c.height = 16385; }, "frame size", "1..16384", "37x16385");
  expect([](DenoiserConfig& c) { c.width = -3; }, "frame size", "1..16384", "-3x29");
  expect([](DenoiserConfig& c) { c.recipe = "magic"; }, "recipe",
         "spatial, traditional, clamp, clamp-box, specular, specular-clamp, svgf, asvgf, paper, "
         "paper-adaptive, reliable",
         "'magic'");
  expect([](DenoiserConfig& c) { c.preset = "slow"; }, "preset", "balanced", "'slow'");
  expect([](DenoiserConfig& c) { c.lights.push_back(c.lights[0]); }, "light 0", "once", "twice");
  expect([](DenoiserConfig& c) { c.lights[1].radius = -1; }, "size of light 7", "0..1e12", "-1");
  expect([](DenoiserConfig& c) { c.lights[0].width = std::nan(""); }, "size of light 0", "0..1e12",
         "nan");
  expect([](DenoiserConfig& c) { c.planes.push_back(test::kGlossyPlane); }, "plane glossy", "once",
         "twice");
  expect([](DenoiserConfig& c) { c.planes.push_back(test::kCompositePlane); }, "plane composite",
         "input plane", "result plane");
  expect([](DenoiserConfig& c) { c.planes.push_back(test::of_light(PlaneKind::kVisibility, 9)); },
         "plane light9.visibility", "light of the session", "light 9");
  expect([](DenoiserConfig& c) { c.planes.erase(c.planes.begin()); }, "plane depth",
         "among the session's planes", "missing");
  expect([](DenoiserConfig& c) { c.planes.erase(c.planes.begin() + 1); }, "plane normal",
         "among the session's planes", "missing");
}

struct BadFrame {
  const char* subject;
  const char* rule;
  const char* value;
  std::function<void(Frame&)> spoil;
};

std::vector<BadFrame> bad_frames() {
  return {
      {"plane glossy", "present", "missing", [](Frame& f) { f.planes.remove(test::kGlossyPlane); }},
      {"plane motion", "one of the session's planes", "not among",
       [](Frame& f) {
         f.planes.add({PlaneKind::kMotion, {}}, 37, 29);
       }},
      {"plane light9.visibility", "one of the session's planes", "not among",
       [](Frame& f) { f.planes.add(test::of_light(PlaneKind::kVisibility, 9), 37, 29); }},
      {"plane depth", "37x29", "36x29", [](Frame& f) { f.planes.add(test::kDepthPlane, 36, 29); }},
      {"plane emission", "37x29", "37x30",
       [](Frame& f) {
         f.planes.add({PlaneKind::kEmission, {}}, 37, 30);
       }},
      {"frame index", "greater than 2", "2", [](Frame& f) { f.index = 2; }},
      {"frame index", "greater than 2", "-5", [](Frame& f) { f.index = -5; }},
      {"light 9", "light of the session", "unknown", [](Frame& f) { f.lights[9] = glm::dmat4(1); }},
      {"transform of light 7", "finite", "nan", [](Frame& f) { f.lights[7][3][2] = std::nan(""); }},
      {"transform of object 2", "finite", "inf", [](Frame& f) { f.objects[2][0][0] = HUGE_VAL; }},
      {"camera viewFromWorld", "invertible", "0",
       [](Frame& f) { f.camera.view_from_world = glm::dmat4(0); }},
      {"camera clipFromView", "finite", "nan",
       [](Frame& f) { f.camera.clip_from_view[2][2] = std::nan(""); }}};
}

TEST(Denoiser, BadFramesAreRejectedAndLeaveNoTrace) {
  const DenoiserConfig config = full_config();
  for (const BadFrame& bad : bad_frames()) {
    Denoiser denoiser(config), undisturbed(config);
    for (int index = 0; index < 3; ++index) {
      test::filtered(denoiser, noisy_frame(config, index));
      test::filtered(undisturbed, noisy_frame(config, index));
    }
    Frame frame = noisy_frame(config, 3, 77);
    bad.spoil(frame);
    PlaneSet results;
    results.add(test::kCompositePlane, 37, 29).channel(0).at(5, 5) = 42.0f;
    expect_input_error([&] { denoiser.filter(frame, results); }, bad.subject, bad.rule, bad.value);
    EXPECT_EQ(results.size(), 1u) << bad.subject;
    EXPECT_EQ(results.at(test::kCompositePlane).channel(0).at(5, 5), 42.0f) << bad.subject;
    for (int index = 3; index < 5; ++index)
      EXPECT_TRUE(test::same_bits(test::filtered(denoiser, noisy_frame(config, index)),
                                  test::filtered(undisturbed, noisy_frame(config, index))))
          << bad.subject;
  }
}

TEST(Denoiser, GapsInTheIndexAreAllowed) {
  const DenoiserConfig config = full_config();
  Denoiser denoiser(config);
  for (const std::int64_t index : {-7, 0, 5})
    EXPECT_NO_THROW(test::filtered(denoiser, noisy_frame(config, index)));
}

/// Writes what no renderer should send into a fifth of a plane's values.
void spoil(Plane& plane, float bad, test::Random& random) {
  for (int c = 0; c < plane.channels(); ++c)
    for (int y = 0; y < plane.height(); ++y)
      for (int x = 0; x < plane.width(); ++x)
        if (random.uniform() < 0.2) plane.channel(c).at(x, y) = bad;
}

bool all_finite(const PlaneSet& results) { return test::largest_difference(results, results) == 0; }

std::uint64_t repaired(const FrameReport& report, PlaneId id) {
  for (const RepairCount& count : report.repaired)
    if (count.plane == id) return count.values;
  return 0;
}

/// Whether a value of a plane is repaired on the way in; others are judged where they are used.
bool is_repaired(PlaneKind kind, float value) {
  if (kind == PlaneKind::kDepth) return std::isnan(value);
  if (kind == PlaneKind::kNormal) return !std::isfinite(value);
  return kind == PlaneKind::kVisibility || kind == PlaneKind::kGlossy ||
         kind == PlaneKind::kIndirect;
}

TEST(Denoiser, SurvivesBadValuesInEveryPlaneUnderEveryRecipe) {
  test::Random random(51);
  for (const std::string& recipe : recipe_names()) {
    DenoiserConfig config = full_config(19, 15);
    config.recipe = recipe;
    config.planes.push_back({PlaneKind::kMotion, {}});
    for (const PlaneId id : config.planes) {
      if (plane_traits(id.kind).scalar == ScalarType::kUint) continue;
      for (const float bad : {test::kNaN, test::kInf, -test::kInf, -1.0f}) {
        Denoiser denoiser(config);
        test::filtered(denoiser, noisy_frame(config, 0));
        Frame frame = noisy_frame(config, 1);
        spoil(*frame.planes.find(id), bad, random);
        PlaneSet results;
        const FrameReport report = denoiser.filter(frame, results);
        EXPECT_TRUE(all_finite(results)) << recipe << " " << plane_name(id) << " " << bad;
        EXPECT_EQ(report.non_finite_out, 0u) << recipe << " " << plane_name(id) << " " << bad;
        EXPECT_EQ(repaired(report, id) > 0, is_repaired(id.kind, bad)) << plane_name(id) << bad;
        PlaneSet next;
        const FrameReport after = denoiser.filter(noisy_frame(config, 2), next);
        EXPECT_TRUE(all_finite(next)) << recipe << " " << plane_name(id) << " " << bad;
        EXPECT_TRUE(after.repaired.empty());
      }
    }
  }
}

/// Goes on with the rows of `frame`'s planes beside them, where the core's own images have zeros:
/// with what each begins with, and with NaN in the frames between.
void spoil_beside_rows(Frame& frame) {
  for (Plane& plane : frame.planes)
    for (int c = 0; c < plane.channels(); ++c) {
      const ChannelView<std::uint32_t> words = plane.words(c);
      for (int y = 0; y < words.height; ++y) {
        std::uint32_t* row = words.row(y);
        std::copy_n(row, words.stride - words.width, row + words.width);
        if (frame.index % 2 == 0)
          std::fill(row + words.width, row + words.stride,
                    std::bit_cast<std::uint32_t>(test::kNaN));
      }
    }
}

// Rows of 256 pixels and more have 16 values beside them that taps read unasked.
TEST(Denoiser, NothingBesideTheRowsOfPlanesShows) {
  for (const char* preset : {"fast", "balanced", "accurate"})
    for (const char* recipe : {"reliable", "paper", "svgf", "spatial"}) {
      DenoiserConfig config = full_config(530, 11);
      config.preset = preset;
      config.recipe = recipe;
      Denoiser spoiled(config), clean(config);
      for (int index = 0; index < 3; ++index) {
        Frame frame = noisy_frame(config, index);
        const PlaneSet expected = test::filtered(clean, frame);
        spoil_beside_rows(frame);
        EXPECT_TRUE(test::same_bits(test::filtered(spoiled, frame), expected))
            << preset << ' ' << recipe << ' ' << index;
      }
    }
}

/// Mean difference of two result sets over all values.
double mean_difference(const PlaneSet& a, const PlaneSet& b) {
  double sum = 0, count = 0;
  for (const Plane& plane : a)
    for (int c = 0; c < plane.channels(); ++c)
      for (int y = 0; y < plane.height(); ++y)
        for (int x = 0; x < plane.width(); ++x, ++count)
          sum += std::abs(double{plane.channel(c).at(x, y)} -
                          double{b.at(plane.id()).channel(c).at(x, y)});
  return sum / count;
}

/// Frame `index` of a scene whose strip of sky and box stand still, ids and vectors included.
Frame still_frame(const DenoiserConfig& config, std::int64_t index) {
  Frame frame = noisy_frame(config, index);
  const Frame first = noisy_frame(config, 0);
  frame.camera = first.camera;
  frame.objects = first.objects;
  frame.lights = first.lights;
  return frame;
}

// Three frames of poison in one plane, every kind of it at random places; 33 frames later the
// picture is what it would have been.
TEST(Denoiser, RecoversFromPoisonInEveryPlaneUnderEveryRecipe) {
  constexpr int kFrom = 4, kTo = 7, kFrames = 40;
  test::Random random(52);
  for (const std::string& recipe : recipe_names()) {
    DenoiserConfig config = full_config(17, 9);
    config.recipe = recipe;
    std::vector<Frame> frames;
    for (int index = 0; index < kFrames; ++index) frames.push_back(still_frame(config, index));
    Denoiser undisturbed(config);
    PlaneSet clean;
    for (const Frame& frame : frames) undisturbed.filter(frame, clean);
    for (const PlaneId id : config.planes) {
      Denoiser denoiser(config);
      PlaneSet results;
      for (int index = 0; index < kFrames; ++index) {
        const auto at = static_cast<std::size_t>(index);
        if (index < kFrom || index >= kTo) {
          const FrameReport report = denoiser.filter(frames[at], results);
          EXPECT_TRUE(report.repaired.empty()) << recipe << " " << plane_name(id) << " " << index;
          continue;
        }
        Frame frame = still_frame(config, index);
        const bool radiance = id.kind == PlaneKind::kGlossy || id.kind == PlaneKind::kIndirect;
        for (const float bad : {test::kNaN, test::kInf, -test::kInf, -3.0f, 1e38f}) {
          if (radiance && bad == 1e38f) continue;  // a light so bright is not forgotten so soon
          if (plane_traits(id.kind).scalar == ScalarType::kFloat) {
            spoil(*frame.planes.find(id), bad, random);
            continue;
          }
          const auto ids = frame.planes.find(id)->ids();
          for (int y = 0; y < ids.height; ++y)
            for (int x = 0; x < ids.width; ++x)
              if (random.uniform() < 0.2) ids.at(x, y) = random.bits();
        }
        denoiser.filter(frame, results);
        EXPECT_TRUE(all_finite(results)) << recipe << " " << plane_name(id) << " " << index;
      }
      EXPECT_LT(mean_difference(results, clean), 0.02) << recipe << " " << plane_name(id);
    }
  }
}

TEST(Denoiser, CountsWhatItRepairs) {
  const DenoiserConfig config = full_config();
  Denoiser denoiser(config);
  Frame frame = noisy_frame(config, 0);
  frame.planes.find(test::kDepthPlane)->channel(0).at(9, 9) = test::kNaN;
  frame.planes.find(test::kDepthPlane)->channel(0).at(10, 9) = -1.0f;  // that is sky, not a repair
  for (int c = 0; c < 3; ++c) frame.planes.find(test::kNormalPlane)->channel(c).at(5, 20) = 0.0f;
  frame.planes.find(test::kNormalPlane)->channel(1).at(6, 20) = test::kInf;
  frame.planes.find(test::kGlossyPlane)->channel(2).at(4, 4) = test::kNaN;
  frame.planes.find(test::kGlossyPlane)->channel(1).at(4, 4) = -2.0f;
  frame.planes.find(test::kGlossyPlane)->channel(0).at(5, 4) = 1e20f;
  PlaneSet results;
  const FrameReport report = denoiser.filter(frame, results);
  EXPECT_EQ(repaired(report, test::kDepthPlane), 1u);
  EXPECT_EQ(repaired(report, test::kNormalPlane), 2u);
  EXPECT_EQ(repaired(report, test::kGlossyPlane), 3u);
  EXPECT_EQ(report.repaired.size(), 3u);
}

TEST(FrameInput, RepairsSignalsToTheirStatedValues) {
  Plane visibility(test::of_light(PlaneKind::kVisibility), 6, 1), glossy(test::kGlossyPlane, 6, 1);
  const float values[] = {0.5f, test::kNaN, test::kInf, -test::kInf, -1.0f, 1e30f};
  for (int x = 0; x < 6; ++x)
    visibility.channel(0).at(x, 0) = glossy.channel(0).at(x, 0) = values[x];
  Channels<float> out(6, 1, 3);
  EXPECT_EQ(load_signal(visibility, out), 5u);
  for (int x = 1; x < 6; ++x) EXPECT_EQ(out[0].at(x, 0), 1.0f) << "nothing is known to block";
  EXPECT_EQ(load_signal(glossy, out), 5u);
  EXPECT_EQ(out[0].at(0, 0), 0.5f);
  for (int x = 1; x < 5; ++x) EXPECT_EQ(out[0].at(x, 0), 0.0f);
  EXPECT_EQ(out[0].at(5, 0), kLargestRadiance);
}

TEST(FrameInput, NormalisesNormalsAndTurnsBadOnesToTheCamera) {
  Guides guides = test::wall(test::perspective_camera(3, 1), 3, 1);
  Plane normal(test::kNormalPlane, 3, 1);
  normal.channel(0).at(0, 0) = 3.0f;
  normal.channel(1).at(0, 0) = 4.0f;
  normal.channel(1).at(1, 0) = test::kNaN;
  EXPECT_EQ(load_normals(normal, guides), 2u);
  EXPECT_NEAR(guides.normal_at(0, 0).x, 0.6f, 1e-6f);
  EXPECT_NEAR(guides.normal_at(0, 0).y, 0.8f, 1e-6f);
  EXPECT_EQ(guides.normal_at(1, 0), glm::vec3(0, 0, 1));
  EXPECT_EQ(guides.normal_at(2, 0), glm::vec3(0, 0, 1));
}

}  // namespace
}  // namespace holdfast
