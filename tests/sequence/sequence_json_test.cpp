#include "client/sequence/sequence_json.h"

#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/sequence/expect_input_error.h"
#include "tests/sequence/temp_dir.h"

namespace holdfast {
namespace {

using Json = nlohmann::json;
using test::expect_input_error;
using test::TempDir;

const Json kIdentity{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

/// The smallest valid file, with one light and two frames.
Json valid() {
  const Json camera{{"viewFromWorld", kIdentity}, {"clipFromView", kIdentity}};
  return {{"format", "holdfast-sequence"},
          {"version", 1},
          {"width", 4},
          {"height", 3},
          {"lights", {{{"id", 0}, {"shape", "rectangle"}, {"width", 1.5}, {"height", 0.5}}}},
          {"frames", {{{"index", 3}, {"camera", camera}}, {{"index", 7}, {"camera", camera}}}}};
}

SequenceDescription read(const Json& json) {
  const TempDir dir;
  std::ofstream(dir / "sequence.json") << json;
  return read_sequence_json(dir / "sequence.json");
}

/// Expects an error after `value` was put at a JSON pointer of a valid file.
void expect_error_with(const char* pointer, const Json& value,
                       std::initializer_list<std::string> parts) {
  Json json = valid();
  json[Json::json_pointer(pointer)] = value;
  SCOPED_TRACE(pointer);
  expect_input_error([&] { read(json); }, parts);
}

TEST(SequenceJson, OnlyRequiredKeysAreEnough) {
  Json json = valid();
  json.erase("lights");
  const SequenceDescription description = read(json);
  EXPECT_EQ(description.header.frame_rate, 30);
  EXPECT_TRUE(description.header.lights.empty());
  ASSERT_EQ(description.frames.size(), 2u);
  EXPECT_EQ(description.frames[1].index, 7);
  EXPECT_FALSE(description.frames[1].cut);
}

TEST(SequenceJson, RadianceOfALightIsOptionalAndSurvivesWriting) {
  Json json = valid();
  EXPECT_EQ(read(json).header.lights[0].radiance, glm::dvec3(0));
  json["lights"][0]["radiance"] = {1.5, 0, 2e3};
  const SequenceDescription description = read(json);
  EXPECT_EQ(description.header.lights[0].radiance, glm::dvec3(1.5, 0, 2e3));
  const TempDir dir;
  write_sequence_json(dir / "sequence.json", description.header, description.frames);
  EXPECT_EQ(read_sequence_json(dir / "sequence.json").header.lights[0].radiance,
            glm::dvec3(1.5, 0, 2e3));
}

TEST(SequenceJson, MatricesAreRowMajor) {
  Json json = valid();
  json["frames"][0]["camera"]["viewFromWorld"][3] = 5.5;  // row 0, column 3: translation along x
  const glm::dmat4 matrix = read(json).frames[0].camera.view_from_world;
  EXPECT_EQ((matrix * glm::dvec4(0, 0, 0, 1)).x, 5.5);
}

TEST(SequenceJson, EachMissingRequiredKeyIsNamed) {
  for (const char* key : {"format", "version", "width", "height", "frames"}) {
    Json json = valid();
    json.erase(key);
    expect_input_error([&] { read(json); }, {"sequence.json", key, "missing"});
  }
  for (const char* key : {"viewFromWorld", "clipFromView"}) {
    Json json = valid();
    json["frames"][1]["camera"].erase(key);
    expect_input_error([&] { read(json); }, {"frames[1].camera", key, "missing"});
  }
  for (const char* key : {"index", "camera"}) {
    Json json = valid();
    json["frames"][1].erase(key);
    expect_input_error([&] { read(json); }, {"frames[1]", key, "missing"});
  }
}

TEST(SequenceJson, EachUnknownKeyIsNamedWithItsPath) {
  expect_error_with("/fps", 30, {"sequence.json, fps", "unknown"});
  expect_error_with("/lights/0/radius", 1, {"lights[0].radius", "unknown"});
  expect_error_with("/frames/1/time", 1, {"frames[1].time", "unknown"});
  expect_error_with("/frames/1/camera/fov", 1, {"frames[1].camera.fov", "unknown"});
}

TEST(SequenceJson, EachWrongValueStatesRuleAndValue) {
  expect_error_with("/format", "exr", {"format", "holdfast-sequence", "exr"});
  expect_error_with("/version", 2, {"version", "must be 1", "is 2"});
  expect_error_with("/width", 0, {"width", "1..16384", "is 0"});
  expect_error_with("/height", 2.5, {"height", "integer", "2.5"});
  expect_error_with("/frameRate", 0, {"frameRate", "> 0"});
  expect_error_with("/lights", Json::object(), {"lights", "array"});
  expect_error_with("/lights/0/shape", "mesh", {"lights[0].shape", "rectangle", "mesh"});
  expect_error_with("/lights/0/width", -1, {"lights[0].width", ">= 0", "-1"});
  for (const Json& bad : {Json(3), Json({1, 2}), Json({1, 2, -1}), Json({1, "a", 2})})
    expect_error_with("/lights/0/radiance", bad, {"lights[0].radiance", "3 numbers >= 0"});
  expect_error_with("/frames", Json::array(), {"frames", "at least one"});
  expect_error_with("/frames/0/cut", 1, {"frames[0].cut", "true or false", "is 1"});
  expect_error_with("/frames/0/camera/viewFromWorld", {1, 2, 3},
                    {"viewFromWorld", "16", "[1,2,3]"});
  expect_error_with("/frames/0/camera/clipFromView/5", "a", {"clipFromView", "16"});
  expect_error_with("/frames/0/camera/jitterPx", {1}, {"jitterPx", "2 numbers", "[1]"});
  expect_error_with("/frames/0/objects", {{"0", kIdentity}}, {"objects.0", "1..4294967295"});
  expect_error_with("/frames/0/objects", {{"4294967296", kIdentity}}, {"4294967296"});
  expect_error_with("/frames/0/objects", {{"fence", kIdentity}}, {"objects.fence", "an id"});
}

TEST(SequenceJson, FrameIndexThatGoesBackIsAnError) {
  expect_error_with("/frames/1/index", 3, {"frames[1].index", "greater than", "before, 3", "is 3"});
}

TEST(SequenceJson, TransformOfAnUnknownLightIsAnError) {
  expect_error_with("/frames/1/lights", {{"2", kIdentity}}, {"frames[1].lights", "is 2"});
}

TEST(SequenceJson, IdListedTwiceIsAnError) {
  expect_error_with("/objects", {{{"id", 5}}, {{"id", 5}}}, {"objects", "once", "5 twice"});
}

TEST(SequenceJson, MissingFileAndBrokenJsonAreNamed) {
  const TempDir dir;
  expect_input_error([&] { read_sequence_json(dir / "sequence.json"); },
                     {"sequence.json", "missing"});
  std::ofstream(dir / "sequence.json") << "{ \"format\": ";
  expect_input_error([&] { read_sequence_json(dir / "sequence.json"); },
                     {"sequence.json", "valid JSON"});
}

}  // namespace
}  // namespace holdfast
