#include "client/sequence/sequence.h"
#include "tests/cli/program_test.h"

namespace holdfast {
namespace {

using Json = nlohmann::json;

/// `holdfast check` and `holdfast show` on a rendered room of three frames.
class Inspect : public test::ProgramTest {
 protected:
  void SetUp() override { render("room", {"--frames", "3", "--reference-spp", "0"}); }

  Json json(const std::string& name) const {
    return Json::parse(test::file_text(dir / name), nullptr, false);
  }
};

TEST_F(Inspect, CheckEndsWithZeroForARightSequence) {
  EXPECT_EQ(holdfast({"check", path("in"), "--json", path("check.json")}), 0) << text;
  EXPECT_NE(text.find("nothing wrong was found"), std::string::npos) << text;
  const Json report = json("check.json");
  EXPECT_EQ(test::keys(report), (std::vector<std::string>{"checks", "findings", "frames"}));
  EXPECT_EQ(report["frames"], 3);
  EXPECT_TRUE(report["findings"].empty());
  for (const Json& line : report["checks"]) EXPECT_EQ(line["verdict"], "ok") << line;
}

TEST_F(Inspect, CheckEndsWithTwoAndNamesThingRuleAndEvidence) {
  Json sequence = json("in/sequence.json");
  for (Json& frame : sequence["frames"]) {
    Json& clip = frame["camera"]["clipFromView"];
    clip[5] = -clip[5].get<double>();
  }
  std::ofstream(dir / "in/sequence.json") << sequence.dump();
  EXPECT_EQ(holdfast({"check", path("in"), "--quiet", "--json", path("check.json")}), 2);
  for (const char* part : {"camera.clipFromView", "must have y upwards", "pixels"})
    EXPECT_NE(text.find(part), std::string::npos) << text;
  const Json finding = json("check.json")["findings"].at(0);
  EXPECT_EQ(finding["mistake"], "clip-flipped-y");
  EXPECT_GT(finding["share"], 0.6);
}

TEST_F(Inspect, ShowWritesPicturesOfEachComponentAndOfTheSurface) {
  replay("out", {"--debug"});
  ASSERT_EQ(holdfast({"show", path("out"), "--sequence", path("in"), "-o", path("png"), "--frames",
                      "1-2", "--quiet", "--json", path("show.json")}),
            0)
      << text;
  const Json pictures = json("show.json")["pictures"];
  EXPECT_EQ(pictures.size(), 2u * (3 * 4 + 2)) << pictures;
  for (const std::string name : pictures)
    EXPECT_TRUE(test::file_text(dir / ("png/" + name)).starts_with("\x89PNG")) << name;
  for (const char* name :
       {"frame.0001.light0.visibility.motion.png", "frame.0002.glossy.fallback.png",
        "frame.0002.surface.motion-minus-static.png"})
    EXPECT_NE(std::find(pictures.begin(), pictures.end(), name), pictures.end()) << name;
}

TEST_F(Inspect, ShowNamesResultsWithoutDebugPlanesAndFramesThatAreMissing) {
  replay("out");
  const auto show = [&](const std::string& frames) {
    return holdfast({"show", path("out"), "--sequence", path("in"), "-o", path("png"), "--frames",
                     frames, "--quiet"});
  };
  EXPECT_EQ(show("1"), 2);
  EXPECT_NE(text.find("must have debug planes"), std::string::npos) << text;
  EXPECT_EQ(show("7-9"), 2);
  EXPECT_NE(text.find("--frames"), std::string::npos) << text;
  std::filesystem::remove(sequence_file(dir / "out", "frame", 2));
  EXPECT_EQ(show("2"), 2);
  EXPECT_NE(text.find("frame.0002.exr"), std::string::npos) << text;
}

}  // namespace
}  // namespace holdfast
