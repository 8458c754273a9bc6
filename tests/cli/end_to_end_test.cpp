#include <cmath>
#include <limits>

#include "client/sequence/sequence.h"
#include "core/denoiser/denoiser.h"
#include "tests/cli/program_test.h"
#include "tests/service/test_frames.h"

namespace holdfast {
namespace {

using test::keys;
using Names = std::vector<std::string>;

class EndToEnd : public test::ProgramTest {
 protected:
  /// Rewrites every frame of "in" after `change(planes)`.
  template <class Change>
  void rewrite_frames(const Change& change) {
    const SequenceReader sequence(dir / "in");
    for (const std::int64_t index : sequence.frame_indices()) {
      Frame frame = sequence.read_frame(index);
      change(frame.planes);
      write_exr(sequence_file(dir / "in", "frame", index), frame.planes);
    }
  }

  /// Every value of every result is finite.
  void expect_finite(const std::string& out, const std::vector<std::int64_t>& frames) {
    for (const std::int64_t index : frames)
      for (const Plane& plane : read_exr(sequence_file(dir / out, "frame", index)))
        for (int c = 0; c < plane.channels(); ++c)
          for (int y = 0; y < plane.height(); ++y)
            for (int x = 0; x < plane.width(); ++x)
              ASSERT_TRUE(std::isfinite(plane.channel(c).at(x, y)))
                  << plane_name(plane.id()) << " of frame " << index << " at " << x << "," << y;
  }

  void expect_bits_of_the_core(const std::string& out) {
    const SequenceReader sequence(dir / "in");
    DenoiserConfig config;
    config.width = sequence.header().width;
    config.height = sequence.header().height;
    config.lights = sequence.header().lights;
    config.planes = sequence.planes();
    Denoiser denoiser(config);
    for (const std::int64_t index : sequence.frame_indices()) {
      PlaneSet expected;
      denoiser.filter(sequence.read_frame(index), expected);
      EXPECT_TRUE(test::same_bits(read_exr(sequence_file(dir / out, "frame", index)), expected))
          << "frame " << index;
    }
  }
};

TEST_F(EndToEnd, RenderReplayAndCompareAgreeOnKeysAndFrames) {
  // Frames numbered from 1, references for every other one.
  render("fence", {"--frames", "5", "--first", "1", "--reference-spp", "16", "--reference-every",
                   "2", "--json", path("render.json")});
  EXPECT_TRUE(std::filesystem::exists(sequence_file(dir / "in", "reference", 1)));
  EXPECT_FALSE(std::filesystem::exists(sequence_file(dir / "in", "reference", 2)));
  EXPECT_FALSE(std::filesystem::exists(sequence_file(dir / "in", "frame", 0)));

  const auto replayed = replay("out");
  EXPECT_EQ(keys(replayed),
            (Names{"bytes_in", "bytes_out", "frames", "height", "ms", "non_finite_in",
                   "non_finite_out", "preset", "recipe", "width"}));
  EXPECT_EQ(keys(replayed["ms"]), (Names{"core", "total"}));
  EXPECT_EQ(keys(replayed["ms"]["core"]), (Names{"p50", "p95", "p99"}));
  EXPECT_EQ(replayed["frames"], 5);
  EXPECT_EQ(replayed["recipe"], "reliable");
  EXPECT_EQ(replayed["non_finite_in"], 0);
  EXPECT_EQ(replayed["non_finite_out"], 0);
  // depth, normal, objectId, emission, unshadowed, visibility, distance, blocker, sample u and v
  EXPECT_EQ(replayed["bytes_in"], 5 * 64 * 36 * 4 * (1 + 3 + 1 + 3 + 3 + 1 + 1 + 1 + 2));
  EXPECT_EQ(replayed["bytes_out"], 5 * 64 * 36 * 4 * (3 + 1));

  for (const char* mask : {"image", "effect"}) {
    const auto compared = compare("out", {"--mask", mask, "--html", path("page.html")});
    EXPECT_EQ(compared["frames"], 3) << "those with a reference";
    EXPECT_EQ(compared["mask"], mask);
    EXPECT_EQ(keys(compared["layers"]), (Names{"composite", "light0.visibility"}));
    const auto& layer = compared["layers"]["light0.visibility"];
    EXPECT_EQ(keys(layer), (Names{"flicker", "flip", "judged_pixels", "measure", "non_finite",
                                  "per_frame", "psnr", "rmse", "ssim"}));
    EXPECT_EQ(layer["non_finite"], 0);
    EXPECT_GT(layer["rmse"], 0.0);
    for (const auto& frame : layer["per_frame"]) {
      EXPECT_EQ(keys(frame), (Names{"frame", "rmse"}));
      EXPECT_EQ(frame["frame"].get<int>() % 2, 1);
    }
    EXPECT_NE(test::file_text(dir / "page.html").find("</html>"), std::string::npos);
  }
}

TEST_F(EndToEnd, ReplayWritesTheBitsOfTheCoreForARenderedShadow) {
  render("fence", {"--frames", "6", "--speed", "4", "--reference-spp", "0"});
  for (const char* threads : {"1", "2"}) {
    replay("out", {"--threads", threads});
    expect_bits_of_the_core("out");
  }
}

TEST_F(EndToEnd, GradientsAreSentOnlyToRecipesThatUseThem) {
  render("fence", {"--frames", "4", "--speed", "4", "--reference-spp", "0"});
  const int gradients = 4 * (22 * 12) * 2 * 4;  // frames, strata of 64x36, (now, then), bytes
  const auto fixed = replay("svgf", {"--recipe", "svgf"});
  const auto adaptive = replay("asvgf", {"--recipe", "asvgf"});
  EXPECT_EQ(adaptive["bytes_in"].get<int>(), fixed["bytes_in"].get<int>() + gradients);
  const auto last = [&](const char* out) { return read_exr(sequence_file(dir / out, "frame", 3)); };
  EXPECT_FALSE(test::same_bits(last("svgf"), last("asvgf")));
  render("fence", {"--frames", "4", "--speed", "4", "--reference-spp", "0", "--no-gradients"});
  EXPECT_EQ(replay("none", {"--recipe", "asvgf"})["bytes_in"], fixed["bytes_in"]);
  EXPECT_TRUE(test::same_bits(last("svgf"), last("none")));
}

TEST_F(EndToEnd, EveryRecipeIsBetterThanTheNoise) {
  render("fence", {"--frames", "4", "--reference-spp", "64"});
  rewrite_frames([](PlaneSet&) {});
  for (const std::string& recipe : recipe_names()) {
    EXPECT_EQ(replay("out", {"--recipe", recipe})["recipe"], recipe);
    const auto compared = compare("out", {"--no-flip"});
    const auto& layer = compared["layers"]["light0.visibility"];
    EXPECT_LT(layer["rmse"], 0.2) << recipe << "; one sample a pixel has about 0.25";
  }
}

TEST_F(EndToEnd, ComponentsFallBackWithoutBlockersHitsAndDirections) {
  render("room", {"--frames", "3", "--reference-spp", "4"});
  rewrite_frames([](PlaneSet& planes) {
    std::vector<PlaneId> gone;
    for (const Plane& plane : planes) switch (plane.id().kind) {
        case PlaneKind::kBlockerDistance:
        case PlaneKind::kBlockerId:
        case PlaneKind::kLightSample:
        case PlaneKind::kGlossyDirection:
        case PlaneKind::kGlossyHitDistance:
        case PlaneKind::kGlossyHitId:
        case PlaneKind::kIndirectDirection: gone.push_back(plane.id()); break;
        default: break;
      }
    EXPECT_GE(gone.size(), 7u);
    for (const PlaneId id : gone) planes.remove(id);
  });
  for (const std::string& recipe : recipe_names()) {
    EXPECT_EQ(replay("out", {"--recipe", recipe})["non_finite_out"], 0) << recipe;
    expect_finite("out", {0, 1, 2});
    const auto compared = compare("out", {"--no-flip"});
    EXPECT_TRUE(compared["layers"].contains("glossy") && compared["layers"].contains("indirect"));
  }
  expect_bits_of_the_core("out");
}

TEST_F(EndToEnd, ValuesThatAreNotFiniteAreCountedAndDoNotComeOut) {
  render("room", {"--frames", "3", "--reference-spp", "0"});
  const float nan = std::numeric_limits<float>::quiet_NaN();
  std::uint64_t bad = 0;
  rewrite_frames([&](PlaneSet& planes) {
    for (Plane& plane : planes) {
      if (plane.is_uint()) continue;
      for (int c = 0; c < plane.channels(); ++c, ++bad) plane.channel(c).at(20, 30) = nan;
    }
  });
  for (const std::string& recipe : recipe_names()) {
    const auto result = replay("out", {"--recipe", recipe, "--debug"});
    EXPECT_GT(result["non_finite_in"], 0) << recipe;
    EXPECT_LE(result["non_finite_in"].get<std::uint64_t>(), bad) << recipe;
    EXPECT_EQ(result["non_finite_out"], 0) << recipe;
    expect_finite("out", {0, 1, 2});
  }
}

TEST_F(EndToEnd, OnAStillSceneReliableIsNoWorseThanSvgf) {
  ASSERT_EQ(holdfast({"render", "static", "-o", path("in"), "--size", "240x135", "--frames", "24",
                      "--reference-spp", "256", "--reference-every", "23", "--quiet"}),
            0)
      << text;
  for (const std::string& recipe : recipe_names())
    EXPECT_EQ(replay(recipe, {"--recipe", recipe})["non_finite_out"], 0) << recipe;
  const auto svgf = compare("svgf", {"--no-flip"}), reliable = compare("reliable", {"--no-flip"});
  for (const char* layer : {"light0.visibility", "composite"})
    EXPECT_LE(reliable["layers"][layer]["rmse"].get<double>(),
              1.01 * svgf["layers"][layer]["rmse"].get<double>())
        << layer;
}

TEST_F(EndToEnd, TheDemonstrationLeavesAReportPicturesAndFigures) {
  ASSERT_EQ(holdfast({"demo", "-o", path("demo"), "--frames", "3", "--size", "64x36",
                      "--reference-spp", "16", "--json", path("demo.json")}),
            0)
      << text;
  for (const char* part : {"fence, light0.visibility", "cylinder, composite", "reliable",
                           "report.html", "seconds: render fence"})
    EXPECT_NE(text.find(part), std::string::npos) << part;
  const auto json = nlohmann::json::parse(test::file_text(dir / "demo.json"));
  EXPECT_EQ(keys(json), (Names{"scenes", "seconds"}));
  EXPECT_EQ(keys(json["scenes"]), (Names{"cylinder", "fence"}));
  const Names recipes{"spatial", "traditional", "clamp", "svgf", "paper", "reliable"};
  for (const auto& scene : json["scenes"]) {
    ASSERT_EQ(scene.size(), recipes.size());
    for (const std::string& recipe : recipes)
      for (const char* region : {"image", "effect"})
        EXPECT_EQ(scene[recipe][region]["frames"], 3) << recipe;
  }
  const std::string page = test::file_text(dir / "demo/report.html");
  for (const std::string& recipe : recipes)
    EXPECT_NE(page.find("data-name=\"" + recipe + "\""), std::string::npos) << recipe;
  EXPECT_GT(std::filesystem::file_size(dir / "demo/demo.png"), 1000u);
  EXPECT_TRUE(std::filesystem::exists(dir / "demo/png/fence.light0.visibility.reliable.error.png"));
  EXPECT_TRUE(std::filesystem::exists(sequence_file(dir / "demo/cylinder/svgf", "frame", 2)));
}

}  // namespace
}  // namespace holdfast
