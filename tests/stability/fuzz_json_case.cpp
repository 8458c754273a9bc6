#include "tests/stability/fuzz_json_case.h"

#include <cmath>
#include <exception>
#include <fstream>

#include "client/scenes/builtin.h"
#include "client/scenes/mesh.h"
#include "client/scenes/scene_json.h"
#include "client/sequence/sequence_json.h"
#include "core/frame/error.h"
#include "tests/stability/peak_memory.h"

namespace holdfast::test {
namespace {

constexpr std::size_t kMemoryBase = 1u << 20, kMemoryFactor = 300, kMemoryLimit = 512u << 20;
constexpr std::size_t kLongestMessage = 1000;  // beside the file's name

/// Every kind of part, motion and light once.
constexpr const char* kScene = R"({"format":"holdfast-scene","version":1,"name":"all",
"frameRate":30,"components":["visibility","glossy","indirect"],
"sky":{"horizon":[1,1,1],"zenith":0.5},"ambient":0.1,
"camera":{"verticalFovDeg":40,"near":0.1,"far":100,"motion":{"repeat":"mirror","keys":[
{"frame":0,"translation":[0,1,4],"lookAt":[0,0,0]},{"frame":8.5,"translation":[1,1,4],
"rotation":[0,0,0,1],"jump":true}]}},
"objects":[{"id":1,"name":"things","fromFrame":2,"motion":{"translation":[0,0,0],
"scale":[1,2,1]},"material":{"albedo":0.5,"checker":{"albedo":[0.1,0.2,0.3],"size":0.5},
"roughness":0.3,"specular":0.04,"emission":[0,0,1]},"parts":[{"shape":"box","size":[1,2,3]},
{"shape":"quad","size":[4,5]},{"shape":"sphere","radius":0.3,"translation":[1,0,0]},
{"shape":"cylinder","radius":0.1,"height":2},{"shape":"mesh","file":"a.obj","scale":[1,1,-1]}]}],
"lights":[{"id":0,"shape":"rectangle","width":1,"height":0.5,"emission":4},
{"id":1,"shape":"sphere","radius":0.1,"emission":[1,2,3],"fromFrame":3,
"motion":{"translation":[0,2,0]}},{"id":2,"shape":"directional","emission":1}]})";

constexpr const char* kSequence = R"({"format":"holdfast-sequence","version":1,"width":24,
"height":16,"frameRate":30,"lights":[{"id":0,"shape":"rectangle","width":1.5,"height":0.5},
{"id":7,"shape":"disk","radius":0.5,"radiance":[1,2,3]},{"id":9,"shape":"point"}],
"objects":[{"id":1,"name":"fence"},{"id":4294967295}],"frames":[{"index":0,"cut":true,
"camera":{"viewFromWorld":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1],"clipFromView":[1,0,0,0,0,1,0,0,0,0,
-1.002,-0.2002,0,0,-1,0],"jitterPx":[0.25,-0.25]},"objects":{"1":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]},
"lights":{"0":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]}},{"index":5,"camera":{"viewFromWorld":
[1,0,0,0.5,0,1,0,0,0,0,1,0,0,0,0,1],"clipFromView":[1,0,0,0,0,1,0,0,0,0,-1.002,-0.2002,0,0,-1,0]}}
]})";

constexpr const char* kMesh =
    "# a tetrahedron\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1e-3\nvn 0 0 1\nvn 0 1 0\nvt 0 0\n"
    "f 1 2 3\nf 1//1 2//2 4//1\nf 1/1/1 3/1/2 4/1/-1\nf -4 -3 -2 -1\nusemtl none\n";

constexpr std::string_view kMeshWords[] = {" ",
                                           "\n",
                                           "/",
                                           "//",
                                           "f ",
                                           "v ",
                                           "vn ",
                                           "0",
                                           "-1",
                                           "99999999999999999999",
                                           "1e999",
                                           "nan",
                                           "inf",
                                           "1e38",
                                           "-",
                                           "1/1",
                                           "1//1",
                                           "5",
                                           "f 1 1 1\n",
                                           "v 1 2\n",
                                           "f 1 2\n",
                                           "\r",
                                           "v 1e39 0 0\n",
                                           "-9223372036854775808",
                                           std::string_view("\0", 1)};

bool finite(const glm::dvec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

std::string check_motion(const scenes::Motion& motion) {
  for (const scenes::Key& key : motion.keys) {
    const scenes::Transform& t = key.transform;
    const glm::dmat4 m = t.matrix();
    for (int c = 0; c < 4; ++c)
      if (!finite(m[c])) return "a transform is not finite";
    if (!(std::abs(glm::length(t.rotation) - 1.0) < 2e-3)) return "a rotation is not one";
  }
  return {};
}

std::string check_scene(const std::filesystem::path& file) {
  const scenes::Scene scene = scenes::read_scene(file);
  std::string problem = check_motion(scene.camera.motion);
  for (const scenes::Object& object : scene.objects) {
    if (problem.empty()) problem = check_motion(object.motion);
    for (const scenes::Part& part : object.parts)
      if (problem.empty()) problem = check_motion(scenes::Motion(part.placement));
  }
  for (const scenes::SceneLight& light : scene.lights) {
    if (problem.empty()) problem = check_motion(light.motion);
    if (!finite(light.emission)) problem = "an emission is not finite";
  }
  return problem;
}

std::string check_sequence(const std::filesystem::path& file) {
  const SequenceDescription sequence = read_sequence_json(file);
  const auto good = [](int size) { return size >= 1 && size <= kMaxDimension; };
  if (!good(sequence.header.width) || !good(sequence.header.height)) return "a size is wrong";
  for (const Frame& frame : sequence.frames)
    for (int c = 0; c < 4; ++c)
      if (!finite(frame.camera.view_from_world[c]) || !finite(frame.camera.clip_from_view[c]))
        return "a camera is not finite";
  return sequence.frames.empty() ? "there is no frame" : "";
}

std::string check_mesh(const std::filesystem::path& file) {
  const scenes::Mesh mesh = scenes::read_obj(file);
  if (mesh.normals.size() != mesh.positions.size()) return "normals are too many or too few";
  for (const glm::uvec3& t : mesh.triangles)
    if (t.x >= mesh.positions.size() || t.y >= mesh.positions.size() ||
        t.z >= mesh.positions.size())
      return "a triangle has a corner that is not there";
  for (const glm::vec3& p : mesh.positions)
    if (!finite(p)) return "a position is not finite";
  return mesh.triangles.empty() ? "there is no triangle" : "";
}

using Check = std::string (*)(const std::filesystem::path& file);

/// What is wrong with what the reader does; counts what it does.
std::string read(const std::filesystem::path& file, Check check, ReadOutcome& outcome) {
  try {
    const std::string problem = check(file);
    ++outcome.accepted;
    return problem;
  } catch (const InputError& error) {
    ++outcome.refused;
    const std::string message = error.what();
    if (message.find(file.string()) == message.npos) return "no file in the message: " + message;
    if (message.size() > file.string().size() + kLongestMessage)
      return "a message of " + std::to_string(message.size()) + " bytes";
  } catch (const std::exception& error) {
    return std::string("it threw: ") + error.what();
  }
  return {};
}

}  // namespace

ReadOutcome fuzz_json(std::uint32_t seed, const std::filesystem::path& folder) {
  ReadOutcome outcome;
  Random random(seed);
  const std::size_t kind = below(random, 3);
  const std::string valid = kind == 0 ? kSequence : kind == 1 ? kScene : kMesh;
  std::string text;
  if (kind == 2)
    text = damaged(valid, random, kMeshWords);
  else
    text = chance(random, 0.75) ? damaged_json(valid, random) : damaged(valid, random);
  const std::filesystem::path file = folder / (kind == 2 ? "damaged.obj" : "damaged.json");
  std::ofstream(file, std::ios::binary) << text;
  constexpr Check kChecks[] = {check_sequence, check_scene, check_mesh};
  const PeakMemory peak(kMemoryLimit);
  outcome.problem = read(file, kChecks[kind], outcome);
  const std::size_t most = kMemoryBase + kMemoryFactor * text.size();
  if (outcome.problem.empty() && peak.bytes() > most)
    outcome.problem =
        std::to_string(peak.bytes()) + " bytes for a file of " + std::to_string(text.size());
  return outcome;
}

}  // namespace holdfast::test
