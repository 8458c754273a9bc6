#include "tests/cli/program_test.h"

namespace holdfast {
namespace {

using test::keys;

class Bench : public test::ProgramTest {
 protected:
  nlohmann::json bench(std::vector<std::string> more) {
    more.insert(more.begin(), {"bench", "--frames", "2", "--json", path("bench.json")});
    EXPECT_EQ(holdfast(more), 0) << text;
    return nlohmann::json::parse(test::file_text(dir / "bench.json"), nullptr, false);
  }
};

TEST_F(Bench, TimesEachStageAndEachRecipe) {
  const auto json = bench({"--scene", "fence", "--size", "70x40", "--recipes", "reliable,spatial",
                           "--threads", "1", "--plan"});
  EXPECT_EQ(keys(json),
            (std::vector<std::string>{"frames", "height", "isa", "stages", "threads", "width"}));
  EXPECT_EQ(json["width"], 70);
  EXPECT_EQ(json["height"], 40);
  EXPECT_EQ(json["threads"], 1);
  double sum_ns = 0;
  std::vector<std::string> stages;
  for (const auto& stage : json["stages"]) {
    stages.push_back(stage["stage"]);
    sum_ns += stage["ns_per_pixel"].get<double>();
    EXPECT_GT(stage["ns_per_pixel"].get<double>(), 0) << stage;
    EXPECT_GT(stage["bytes_per_pixel"].get<double>(), 0) << stage;
    EXPECT_GT(stage["reference_ns_per_pixel"].get<double>(), 0) << stage;
  }
  EXPECT_EQ(stages.front(), "guides");
  EXPECT_EQ(stages.back(), "composite");
  EXPECT_NE(std::find(stages.begin(), stages.end(), "light0.visibility.filter"), stages.end());
  ASSERT_EQ(json["frames"].size(), 2u);
  EXPECT_EQ(json["frames"][0]["recipe"], "reliable");
  EXPECT_EQ(json["frames"][1]["recipe"], "spatial");
  // Medians of stages need not add up to the median of frames; within a factor they must.
  const double frame_ns = json["frames"][0]["ms"].get<double>() * 1e6 / (70 * 40);
  EXPECT_LT(sum_ns, 2 * frame_ns);
  EXPECT_GT(sum_ns, 0.3 * frame_ns);
  EXPECT_NE(text.find("recipe reliable"), std::string::npos) << "the plan";
}

TEST_F(Bench, MeasuresWhatTheMachineCanDo) {
  const auto json = bench({"--scene", "fence", "--size", "32x16", "--no-reference", "--limits"});
  const double copied = json["limits"]["copy_gb_per_s"];
  EXPECT_GT(json["limits"]["multiply_adds_per_ns"].get<double>(), 0.05);
  EXPECT_GT(copied, 0.05);
  EXPECT_NE(text.find("multiply-adds of floats/ns"), std::string::npos) << text;
  for (const auto& stage : json["stages"])
    EXPECT_GT(stage["ns_per_pixel"].get<double>(), 0) << stage;
}

TEST_F(Bench, TakesASequenceAtItsOwnSize) {
  render("cylinder", {"--frames", "2", "--reference-spp", "0"});
  const auto json = bench({"--scene", path("in"), "--no-reference", "--quiet"});
  EXPECT_EQ(json["width"], 64);
  EXPECT_EQ(json["height"], 36);
  EXPECT_EQ(json["stages"][0]["reference_ns_per_pixel"], 0.0);
}

TEST_F(Bench, KeepsTheSignalsThatItIsAskedFor) {
  const auto json = bench({"--scene", "room", "--size", "48x27", "--no-reference", "--signals",
                           "visibility,indirect", "--quiet"});
  bool visibility = false, indirect = false;
  for (const auto& stage : json["stages"]) {
    const std::string name = stage["stage"];
    EXPECT_EQ(name.find("glossy"), std::string::npos) << name;
    visibility |= name == "light0.visibility.filter";
    indirect |= name == "indirect.filter";
  }
  EXPECT_TRUE(visibility);
  EXPECT_TRUE(indirect);
  EXPECT_EQ(holdfast({"bench", "--scene", "fence", "--size", "32x16", "--signals", "glossy"}), 2);
  EXPECT_NE(text.find("must name what the scene has"), std::string::npos) << text;
  EXPECT_EQ(holdfast({"bench", "--scene", "fence", "--size", "32x16", "--signals", "shadows"}), 2);
}

TEST_F(Bench, TimesOneSignalUnderSvgf) {
  const auto json =
      bench({"--scene", "occluder", "--size", "96x54", "--threads", "1", "--one-signal"});
  const double kernels = json["one_signal"]["us_per_pixel"];
  EXPECT_GT(kernels, 0);
#if defined(HOLDFAST_ONE_VARIANT)
  const double least = 0;  // the scalar body is the same
#else
  const double least = kernels;
#endif
  EXPECT_GT(json["one_signal"]["reference_us_per_pixel"].get<double>(), least);
  EXPECT_NE(text.find("one signal, svgf, 4 levels"), std::string::npos) << text;
  EXPECT_EQ(holdfast({"bench", "--scene", "fence", "--size", "32x16", "--one-signal"}), 2);
  EXPECT_NE(text.find("needs a scene with indirect light or reflections"), std::string::npos);
}

TEST_F(Bench, MovesRepeatedFramesOverEachLinkBesidePlainSockets) {
  const auto json = bench({"--transport", "--rounds", "1", "--size", "100x50"});
  EXPECT_EQ(json["up_bytes"], 32 * 100 * 50);
  EXPECT_EQ(json["frames"], 2);
  ASSERT_EQ(json["links"].size(), 3u);
  EXPECT_EQ(json["links"][0]["link"], "tcp");
  EXPECT_EQ(json["links"][1]["link"], "unix");
  EXPECT_EQ(json["links"][2]["link"], "shared");
  for (const auto& link : json["links"])
    for (const auto& [key, value] : link.items())
      if (key != "link") {
        EXPECT_GT(value.get<double>(), 0) << key;
      }
}

TEST_F(Bench, RefusesAnUnknownRecipeOrSize) {
  EXPECT_EQ(holdfast({"bench", "--scene", "fence", "--size", "32x16", "--recipes", "none"}), 2);
  EXPECT_NE(text.find("recipe must be one of"), std::string::npos) << text;
  EXPECT_EQ(holdfast({"bench", "--size", "wide"}), 2);
  EXPECT_EQ(holdfast({"bench", "--frames", "0"}), 2);
  EXPECT_EQ(holdfast({"bench", "--transport", "--wire", "none"}), 2);
}

}  // namespace
}  // namespace holdfast
