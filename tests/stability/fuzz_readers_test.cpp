#include <cmath>
#include <cstdio>
#include <fstream>

#include <gtest/gtest.h>

#include "client/scenes/mesh.h"
#include "client/scenes/scene_json.h"
#include "client/sequence/exr.h"
#include "client/sequence/exr_header.h"
#include "client/sequence/sequence_json.h"
#include "core/frame/error.h"
#include "tests/sequence/expect_input_error.h"
#include "tests/sequence/temp_dir.h"
#include "tests/stability/fuzz_exr_case.h"
#include "tests/stability/fuzz_json_case.h"
#include "tests/stability/peak_memory.h"

namespace holdfast::test {
namespace {

/// Cases of seeds from 0 on; most damage is refused, and some is harmless.
template <class Case>
void run(int cases, Case fuzz) {
  const TempDir folder;
  int accepted = 0, refused = 0;
  for (int seed = 0; seed < cases; ++seed) {
    const ReadOutcome outcome = fuzz(static_cast<std::uint32_t>(seed), folder.path());
    ASSERT_EQ(outcome.problem, "") << "seed " << seed;
    accepted += outcome.accepted;
    refused += outcome.refused;
  }
  EXPECT_GT(accepted, cases / 40);
  EXPECT_GT(refused, cases / 2);
}

TEST(FuzzReaders, AnyDamagedJsonOrMeshIsReadOrRefusedByName) { run(1500, fuzz_json); }
TEST(FuzzReaders, AnyDamagedExrFileIsReadOrRefusedByName) { run(1000, fuzz_exr); }

TEST(FuzzReaders, TheWatchOfMemorySeesWhatIsAskedForAndRefusesWhatIsTooMuch) {
  const PeakMemory peak(64u << 20);
  if (std::vector<char>(1u << 20); peak.bytes() == 0) GTEST_SKIP() << "a sanitizer has the heap";
  EXPECT_GE(peak.bytes(), 1u << 20);
  EXPECT_LT(peak.bytes(), 2u << 20);
  EXPECT_THROW(std::vector<char>(65u << 20), std::bad_alloc);
  EXPECT_GE(peak.bytes(), 65u << 20);
}

// What the fuzzers found, by itself.

TEST(HostileJson, NestedADeepWayIsRefusedBeforeAnythingCallsItselfThatOften) {
  const std::string deep = std::string(200000, '[') + std::string(200000, ']');
  for (const std::string& text :
       {deep, "{\"format\":" + deep + "}", "{\"objects\":" + deep + "}", std::string(200000, '[')})
    expect_input_error([&] { scenes::scene_from_json(text, "deep.json"); },
                       {"file deep.json", "must be nested 32 deep at most"});
}

TEST(HostileJson, KeyTwiceInOneObjectIsRefusedByName) {
  expect_input_error([] { scenes::scene_from_json(R"({"a":{"b":1},"b":2,"a":3})", "twice.json"); },
                     {"file twice.json, key \"a\"", "must stand once"});
}

TEST(HostileJson, LongTextIsCutShortInMessages) {
  const std::string longest(1u << 20, 'x');
  for (const std::string& text :
       {'"' + longest, "{\"format\":\"" + longest + "\"}", "{\"" + longest + "\":1,\"format\":2}",
        R"({"format":"holdfast-scene","version":1,"name":"","camera":{")" + longest + "\":1}}"})
    try {
      scenes::scene_from_json(text, "long.json");
      FAIL();
    } catch (const InputError& error) {
      EXPECT_LT(std::string(error.what()).size(), 1000u);
    }
}

TEST(HostileJson, LookingAlongAWayOfAnyLengthIsADirection) {
  const auto camera = [](const std::string& place, const std::string& target) {
    const std::string text =
        R"({"format":"holdfast-scene","version":1,"name":"far","camera":{"motion":{"translation":[)" +
        place + R"(],"lookAt":[)" + target +
        R"(]}},"objects":[{"id":1,"parts":[{"shape":"quad","size":[2,3]}]}]})";
    return scenes::scene_from_json(text, "far.json").camera.motion.keys.front().transform;
  };
  for (const char* length : {"5e-324", "1e-200", "1", "1e200", "1.7e308"}) {
    const std::string zero = "0,0,0", place = std::string("0,") + length + "," + length;
    const glm::dvec3 forward = glm::dmat3(camera(place, zero).matrix()) * glm::dvec3(0, 0, -1);
    EXPECT_NEAR(forward.y, -std::sqrt(0.5), 1e-12) << length;
    EXPECT_NEAR(forward.z, -std::sqrt(0.5), 1e-12) << length;
  }
  expect_input_error([&] { camera("0,0,1.7e308", "0,0,-1.7e308"); },
                     {"lookAt", "must be a finite way from translation"});
}

TEST(HostileJson, SizeBeyondTheLimitIsRefusedBeforeAnythingIsAllocated) {
  const TempDir folder;
  const auto file = folder / "sequence.json";
  for (const char* width : {"1000000000", "1e9", "16385", "-1", "0", "18446744073709551615"}) {
    std::ofstream(file) << R"({"format":"holdfast-sequence","version":1,"width":)" << width
                        << R"(,"height":4,"frames":[]})";
    const PeakMemory peak(64u << 20);
    expect_input_error(
        [&] { read_sequence_json(file); },
        {"sequence.json, width", "must be an integer in 1..16384", width[0] == '1' ? "1" : width});
    EXPECT_LT(peak.bytes(), 1u << 20);
  }
}

/// A small file, and bytes at one place of it instead.
std::string changed(std::string bytes, const std::string& after, std::size_t skip,
                    std::string_view by) {
  const std::size_t at = bytes.find(after) + after.size() + skip;
  return bytes.replace(at, by.size(), by);
}

/// The header of a file whose attributes tell lies is refused before the library believes it.
class HostileExr : public ::testing::Test {
 protected:
  HostileExr() {
    PlaneSet planes;
    planes.add({PlaneKind::kDepth, {}}, 8, 8);
    write_exr(file, planes);
    std::ifstream stream(file, std::ios::binary);
    good.assign(std::istreambuf_iterator<char>(stream), {});
  }
  void expect_refused(const std::string& bytes, const std::string& part) {
    std::ofstream(file, std::ios::binary) << bytes;
    const PeakMemory peak(512u << 20);
    expect_input_error([&] { read_exr(file); }, {file.string(), part});
    EXPECT_LT(peak.bytes(), 1u << 20);
  }

  const TempDir folder;
  const std::filesystem::path file = folder / "hostile.exr";
  std::string good;
};

TEST_F(HostileExr, SmallGoodFileIsRead) {
  const ExrHeader header = check_exr_header(file);
  EXPECT_EQ(header.image_bytes(), 8u * 8 * 4);
  EXPECT_NO_THROW(read_exr(file));
}

TEST_F(HostileExr, AttributeBeyondTheEndOfTheFile) {
  using std::string_view_literals::operator""sv;
  expect_refused(changed(good, "v2f", 1, "\xff\xff\xff\x7f"sv), "beyond its end");
  expect_refused(changed(good, "v2f", 1, "\x07\0\0\0"sv), "of the wrong size");
}

TEST_F(HostileExr, SizesThatNoFileHas) {
  using std::string_view_literals::operator""sv;
  const std::string window("dataWindow\0box2i", 16);
  expect_refused(changed(good, window, 13, "\xff\xff\xff\x7f"sv), "must have width and height");
  expect_refused(changed(good, window, 13, "\xff\x3f\0\0\xff\x3f\0\0"sv), "must have at least");
  expect_refused(changed(good, window, 13, "\xff\xff\xff\xff"sv), "0x8");
}

TEST_F(HostileExr, PreviewTextAndTileLargerThanTheFile) {
  const auto with = [&](const std::string& name, const std::string& type,
                        const std::string& value) {
    std::string size(4, '\0');
    size[0] = static_cast<char>(value.size());
    return good.substr(0, 8) + name + '\0' + type + '\0' + size + value + good.substr(8);
  };
  expect_refused(with("p", "preview", std::string("\xff\x7f\0\0\xff\x7f\0\0", 8)), "wrong size");
  expect_refused(with("s", "stringvector", "\xff\xff\xff\x7f"), "wrong size");
  expect_refused(with("tiles", "tiledesc", std::string("\xff\xff\0\0\xff\xff\0\0\0", 9)), "tiles");
}

TEST_F(HostileExr, CutOffAnywhere) {
  for (std::size_t bytes = 0; bytes < good.size(); bytes += 3) {
    std::ofstream(file, std::ios::binary) << good.substr(0, bytes);
    expect_input_error([&] { read_exr(file); }, {file.string()});
  }
}

}  // namespace
}  // namespace holdfast::test
