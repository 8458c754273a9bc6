// Scene files: round trip, defaults, and each mistake named.

#include "client/scenes/scene_json.h"

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "client/scenes/builtin.h"
#include "client/scenes/mesh.h"
#include "core/frame/error.h"
#include "tests/sequence/temp_dir.h"

namespace holdfast::scenes {
namespace {

const std::string kHead = R"({"format":"holdfast-scene","version":1,"name":"t","camera":{},)";
const std::string kBox = R"("objects":[{"id":1,"parts":[{"shape":"box"}]}])";

std::string error_of(const std::string& text) {
  try {
    scene_from_json(text, "dir/t.json");
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

void expect_error(const std::string& text, const std::string& part) {
  const std::string message = error_of(text);
  EXPECT_NE(message.find(part), std::string::npos) << message;
  EXPECT_NE(message.find("dir/t.json"), std::string::npos) << message;
}

TEST(SceneJson, BuiltinScenesSurviveTheRoundTrip) {
  for (const BuiltinScene& builtin : builtin_scenes()) {
    const Scene before = builtin.make();
    const std::string text = scene_to_json(before);
    const Scene after = scene_from_json(text, "t.json");
    EXPECT_EQ(scene_to_json(after), text) << builtin.name;
    EXPECT_EQ(after.objects, before.objects);
    EXPECT_EQ(after.components, before.components);
    EXPECT_EQ(after.sky, before.sky);
    EXPECT_EQ(after.lights[0].motion, before.lights[0].motion);
    EXPECT_EQ(after.camera.motion, before.camera.motion);
  }
}

TEST(SceneJson, SmallestSceneHasAllComponents) {
  const Scene scene = scene_from_json(kHead + kBox + "}", "t.json");
  EXPECT_EQ(scene.components, (SceneComponents{true, true, true}));
  EXPECT_EQ(scene.frame_rate, 30.0);
  EXPECT_EQ(scene.objects.at(0).parts.at(0).size_m, glm::dvec3(1.0));
}

TEST(SceneJson, ReadsKeysAndLookAt) {
  const Scene scene = scene_from_json(
      R"({"format":"holdfast-scene","version":1,"name":"t",
          "camera":{"motion":{"translation":[0,0,5],"lookAt":[0,0,0]}},
          "objects":[{"id":1,"parts":[{"shape":"quad","size":[2,3]}],
            "motion":{"repeat":"mirror","keys":[{"frame":0},{"frame":4,"translation":[4,0,0]},
                                                {"frame":5,"translation":[9,0,0],"jump":true}]}}]})",
      "t.json");
  EXPECT_NEAR(scene.camera.motion.at(0).matrix()[3].z, 5.0, 1e-12);
  const Motion& motion = scene.objects[0].motion;
  EXPECT_EQ(motion.at(1.0).translation.x, 1.0);
  EXPECT_EQ(motion.at(4.5).translation.x, 4.0);
  EXPECT_EQ(motion.at(7.0).translation.x, 3.0);  // on the way back
}

TEST(SceneJson, NamesEachMistake) {
  expect_error("{", "JSON");
  expect_error("{}", "format");
  expect_error(kHead + "\"objectz\":[]," + kBox + "}", "objectz");
  expect_error(kHead + R"("frameRate":0,)" + kBox + "}", "frameRate must be greater than 0");
  expect_error(kHead + R"("components":["shadow"],)" + kBox + "}", "components");
  expect_error(kHead + R"("objects":[{"id":0,"parts":[{"shape":"box"}]}]})", "objects[0].id");
  expect_error(kHead + R"("objects":[{"id":1,"parts":[]}]})", "objects[0].parts");
  expect_error(kHead + R"("objects":[{"id":1,"parts":[{"shape":"cube"}]}]})",
               "objects[0].parts[0].shape");
  expect_error(kHead + R"("objects":[{"id":1,"parts":[{"shape":"box","radius":1}]}]})", "radius");
  expect_error(kHead + R"("objects":[{"id":1,"parts":[{"shape":"box","size":[1,0,1]}]}]})", "size");
  expect_error(kHead + R"("objects":[{"id":1,"parts":[{"shape":"box"}],"material":{"albedo":2}}]})",
               "objects[0].material.albedo");
  expect_error(
      kHead + R"("objects":[{"id":1,"parts":[{"shape":"box"}],"material":{"roughness":-1}}]})",
      "roughness");
  expect_error(kHead + kBox + R"(,"lights":[{"id":0,"shape":"rectangle","emission":1}]})", "width");
  expect_error(kHead + kBox + R"(,"lights":[{"id":0,"shape":"line","emission":1}]})", "shape");
  expect_error(kHead + kBox + R"(,"lights":[{"id":0,"shape":"point"}]})", "emission");
  expect_error(kHead + kBox + R"(,"lights":[{"id":0,"shape":"point","emission":1,
                               "motion":{"scale":[2,2,2]}}]})",
               "lights[0].motion");
  expect_error(kHead + R"("objects":[{"id":1,"parts":[{"shape":"box"}],
                  "motion":{"keys":[{"frame":2},{"frame":2}]}}]})",
               "objects[0].motion.keys[1].frame");
  expect_error(kHead + R"("objects":[{"id":1,"parts":[{"shape":"box"}],
                  "motion":{"rotation":[1,1,0,0]}}]})",
               "rotation must be a unit quaternion");
}

class ObjFile : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& text) {
    const auto file = directory_ / "mesh.obj";
    std::ofstream(file) << text;
    return file;
  }

 private:
  // One for each test: tests run at the same time, each in a process of its own.
  test::TempDir directory_;
};

TEST_F(ObjFile, PolygonsAndNegativeIndicesAreRead) {
  const Mesh mesh = read_obj(
      write("# square\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0 0 1\nusemtl a\nf 1//1 2//1 3//1 "
            "4//1\nf -4 -3 -2\n"));
  EXPECT_EQ(mesh.triangles.size(), 3u);
  EXPECT_EQ(mesh.normals[mesh.triangles[0].x], glm::vec3(0, 0, 1));
  EXPECT_EQ(mesh.positions[mesh.triangles[2].z], glm::vec3(1, 1, 0));
}

TEST_F(ObjFile, MistakesNameFileAndLine) {
  for (const auto& [text, part] :
       {std::pair{"v 0 0\n", "line 1 must hold three numbers"},
        {"v 0 0 0\nf 1 2 3\n", "line 2 must refer to one of 1 entries, but it is 2"},
        {"v 0 0 0\nf 1 1\n", "line 2 must be a face"},
        {"v 0 0 0\n", "must have at least one face"}}) {
    try {
      read_obj(write(text));
      ADD_FAILURE() << text;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
  }
  EXPECT_THROW(read_obj("no/such/file.obj"), InputError);
}

TEST(Meshes, PointOutwards) {
  for (const Mesh& mesh : {box_mesh({1, 2, 3}), sphere_mesh(0.5, 16), cylinder_mesh(0.5, 2.0, 16)})
    for (const glm::uvec3& t : mesh.triangles) {
      const glm::vec3 a = mesh.positions[t.x], b = mesh.positions[t.y], c = mesh.positions[t.z];
      EXPECT_GT(glm::dot(glm::cross(b - a, c - a), a + b + c), 0.0f);
    }
}

}  // namespace
}  // namespace holdfast::scenes
