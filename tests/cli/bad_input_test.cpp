#include <functional>

#include <OpenImageIO/imageio.h>

#include "client/sequence/sequence.h"
#include "tests/cli/program_test.h"
#include "tests/service/test_frames.h"

namespace holdfast {
namespace {

using Json = nlohmann::json;

/// A good sequence of three frames in the folder "in", for damage.
class BadInput : public test::ProgramTest {
 protected:
  void SetUp() override {
    const DenoiserConfig config = test::small_config();
    SequenceWriter writer(dir / "in", {config.width, config.height, 30, config.lights, {}});
    for (int i = 0; i < 3; ++i) {
      writer.write_frame(test::small_frame(config, i));
      PlaneSet reference;
      reference.add({PlaneKind::kComposite, {}}, config.width, config.height);
      writer.write_reference(i, reference);
    }
    writer.finish();
  }

  /// `holdfast ARGUMENTS` ends with `code` and prints one line that has all of `parts`.
  void expect(int code, const std::vector<std::string>& arguments,
              const std::vector<std::string>& parts) {
    EXPECT_EQ(holdfast(arguments), code) << text;
    for (const std::string& part : parts)
      EXPECT_NE(text.find(part), std::string::npos) << "\"" << part << "\" in: " << text;
  }
  void expect_replay(int code, const std::vector<std::string>& parts) {
    expect(code, {"replay", path("in"), "-o", path("out"), "--quiet"}, parts);
  }

  /// The same after a change of sequence.json.
  void expect_replay_of(const std::function<void(Json&)>& change,
                        const std::vector<std::string>& parts) {
    const auto file = dir / "in/sequence.json";
    const std::string before = test::file_text(file);
    Json json = Json::parse(before);
    change(json);
    std::ofstream(file) << json.dump();
    expect_replay(2, parts);
    std::ofstream(file) << before;
  }

  /// The same after a change of the planes of frame 1.
  void expect_replay_of_planes(const std::function<void(PlaneSet&)>& change,
                               const std::vector<std::string>& parts) {
    const auto file = sequence_file(dir / "in", "frame", 1);
    PlaneSet planes = read_exr(file);
    change(planes);
    write_exr(file, planes);
    expect_replay(2, parts);
    write_exr(file, test::small_frame(test::small_config(), 1).planes);
  }
};

TEST_F(BadInput, TheSequenceIsGoodBeforeItIsDamaged) { expect_replay(0, {}); }

TEST_F(BadInput, KeysOfTheSequenceAreNamedWithRuleAndValue) {
  expect_replay_of([](Json& j) { j["frames"][1].erase("camera"); },
                   {"sequence.json", "frames[1]", "camera", "missing"});
  expect_replay_of([](Json& j) { j["frames"][2]["index"] = 1; },
                   {"sequence.json", "frames[2].index", "greater than", "is 1"});
  expect_replay_of([](Json& j) { j["frames"][1]["lights"]["7"] = j["frames"][0]["lights"]["0"]; },
                   {"frames[1].lights", "is 7"});
  expect_replay_of([](Json& j) { j["fps"] = 30; }, {"sequence.json, fps", "unknown"});
  expect_replay_of([](Json& j) { j["width"] = 38; }, {"frame.0000.exr", "38x21", "37x21"});
  expect_replay_of([](Json& j) { j["frames"][2]["index"] = 9; }, {"frame.0009.exr", "missing"});
  expect_replay_of([](Json& j) { j["lights"] = Json::array(); }, {"is 0"});
  expect_replay_of([](Json& j) { j["lights"][0]["shape"] = "cone"; },
                   {"lights[0].shape", "rectangle", "cone"});
  expect_replay_of(
      [](Json& j) {
        j["frames"][1]["camera"]["clipFromView"] = {1, 2};
      },
      {"frames[1].camera.clipFromView", "16 finite numbers", "[1,2]"});
}

TEST_F(BadInput, ASingularCameraIsNamed) {
  expect_replay_of(
      [](Json& j) {
        for (auto& value : j["frames"][1]["camera"]["clipFromView"]) value = 0;
      },
      {"clip", "but it is"});
}

TEST_F(BadInput, PlanesOfAFrameAreNamedWithRuleAndValue) {
  expect_replay_of_planes(
      [](PlaneSet& planes) {
        planes.clear();
        for (const PlaneId id : test::small_config().planes) planes.add(id, 20, 21);
      },
      {"frame.0001.exr", "37x21", "20x21"});
  expect_replay_of_planes(
      [](PlaneSet& p) {
        p.remove({PlaneKind::kDepth, {}});
      },
      {"frame.0001.exr", "depth", "missing"});
  expect_replay_of_planes(
      [](PlaneSet& p) { p.remove(PlaneId::of_light(PlaneKind::kVisibility, 0)); },
      {"light0.visibility", "missing"});
  expect_replay_of_planes(
      [](PlaneSet& p) {
        p.add({PlaneKind::kAlbedo, {}}, 37, 21);
      },
      {"albedo", "must be", "but it is"});
  expect_replay_of_planes(
      [](PlaneSet& p) { p.add(PlaneId::of_light(PlaneKind::kVisibility, 5), 37, 21); },
      {"light5.visibility", "must be", "but it is"});
}

TEST_F(BadInput, AnUnknownChannelAndADamagedFileAreNamed) {
  const auto file = sequence_file(dir / "in", "frame", 0);
  OIIO::ImageSpec spec(37, 21, 1, OIIO::TypeDesc::FLOAT);
  spec.channelnames = {"beauty.R"};
  const std::vector<float> pixels(37 * 21);
  const auto output = OIIO::ImageOutput::create("openexr");
  ASSERT_TRUE(output->open(file.string(), spec));
  ASSERT_TRUE(output->write_image(OIIO::TypeDesc::FLOAT, pixels.data()));
  output->close();
  expect_replay(2, {"frame.0000.exr", "beauty.R", "must be", "but it is"});
  std::ofstream(file) << "not an image";
  expect_replay(2, {"frame.0000.exr", "must be"});
}

TEST_F(BadInput, CompareNamesWhatItCannotCompare) {
  const auto compare = [&](const std::string& test, std::vector<std::string> more,
                           const std::vector<std::string>& parts) {
    more.insert(more.begin(),
                {"compare", "--test", path(test), "--reference", path("in"), "--quiet"});
    expect(2, more, parts);
  };
  compare("nowhere", {}, {"nowhere", "missing"});
  expect_replay(0, {});
  compare("out", {"--mask", "some"}, {"--mask", "some"});
  compare("out", {"--layers", "depth"}, {"layer depth", "must be composite", "depth"});
  compare("out", {"--layers", "glossy"}, {"layer glossy", "must be in the references", "missing"});
  std::filesystem::remove(sequence_file(dir / "out", "frame", 2));
  compare("out", {}, {"frame.0002.exr", "missing"});
  for (int i = 0; i < 3; ++i) std::filesystem::remove(sequence_file(dir / "in", "reference", i));
  compare("out", {}, {"must have a reference", "without any"});
}

TEST_F(BadInput, RenderNamesWhatItCannotRender) {
  const auto render = [&](const std::string& scene, std::vector<std::string> more,
                          const std::vector<std::string>& parts) {
    more.insert(more.begin(), {"render", scene, "-o", path("scene"), "--quiet"});
    expect(2, more, parts);
  };
  render("castle", {}, {"castle", "fence, cylinder"});
  render("fence", {"--size", "0x36"}, {"width", "1..16384", "is 0"});
  render("fence", {"--size", "64"}, {"--size", "WIDTHxHEIGHT", "is 64"});
  render("fence", {"--frames", "0"}, {"--frames"});
  render("fence", {"--spp", "0"}, {"samples per pixel", "1..1000000", "is 0"});
  render(path("no.json"), {}, {"no.json"});
  std::ofstream(dir / "bad.json") << R"({"format": "holdfast-scene", "version": 2})";
  render(path("bad.json"), {}, {"bad.json", "version", "1", "is 2"});
}

TEST_F(BadInput, WrongArgumentsEndWithTwo) {
  expect(2, {}, {});
  expect(2, {"denoise"}, {"denoise"});
  expect(2, {"replay"}, {"DIR"});
  expect(2, {"demo"}, {"--output"});
  expect(2, {"demo", "-o", path("demo"), "--scenes", "castle", "--quiet"}, {"castle"});
  expect(0, {"--help"}, {"render", "replay", "compare", "demo", "check", "show"});
  for (const char* command : {"render", "replay", "compare", "demo", "check", "show"})
    expect(0, {command, "--help"}, {"--json", "--quiet"});
}

TEST_F(BadInput, FilesThatCannotBeWrittenEndWithOne) {
  expect(1, {"replay", path("in"), "-o", path("out"), "--quiet", "--json", path("no/where.json")},
         {"cannot write", "no/where.json"});
  std::ofstream(dir / "file") << "in the way";
  expect(1, {"render", "fence", "-o", path("file"), "--size", "8x8", "--frames", "1", "--quiet"},
         {"file"});
}

TEST_F(BadInput, ATcpPortInUseIsNamed) {
  test::Program first({HOLDFAST_SERVER_PROGRAM, "--listen", "127.0.0.1:0"}, dir / "first");
  ASSERT_TRUE(first.wait_for("event=listening")) << first.text();
  const std::string log = first.text();
  const auto begin = log.find("127.0.0.1:");
  const std::string address = log.substr(begin, log.find_first_of(" \n", begin) - begin);
  test::Program second({HOLDFAST_SERVER_PROGRAM, "--listen", address}, dir / "second");
  EXPECT_EQ(second.wait(), 2);
  EXPECT_NE(second.text().find(address), std::string::npos) << second.text();
  EXPECT_NE(second.text().find("in use"), std::string::npos) << second.text();
}

}  // namespace
}  // namespace holdfast
