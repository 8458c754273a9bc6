#include <bit>
#include <limits>

#include <nlohmann/json.hpp>

#include "tests/check/checked.h"

namespace holdfast::check::test {
namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// One value of the plane in one of the frames.
void expect_value(PlaneId id, float bad, const std::string& mistake) {
  expect_finding(room(), plane_name(id), mistake, [&](Frame& f) {
    if (f.index == 2) f.planes.find(id)->channel(0).at(40, 30) = bad;
  });
}

TEST(ValueMistakes, ValuesThatAreNotFiniteAreCountedByPlane) {
  expect_value({PlaneKind::kGlossy, {}}, kNan, "not-finite");
  expect_value({PlaneKind::kIndirect, {}}, kInf, "not-finite");
  expect_value({PlaneKind::kDepth, {}}, kNan, "not-finite");
  expect_value(PlaneId::of_light(PlaneKind::kBlockerDistance, 0), kNan, "not-finite");
}

TEST(ValueMistakes, AnInfiniteDistanceIsNoMistake) {
  Sequence sequence = room().copy();
  for (Frame& f : sequence.frames) {
    f.planes.find({PlaneKind::kGlossyHitDistance, {}})->channel(0).at(40, 30) = kInf;
    f.planes.find({PlaneKind::kDepth, {}})->channel(0).at(40, 30) = kInf;
  }
  EXPECT_EQ(mistakes(sequence.check()), std::vector<std::string>());
}

TEST(ValueMistakes, NegativeDistancesAreNamed) {
  expect_value(PlaneId::of_light(PlaneKind::kBlockerDistance, 0), -0.5f, "negative");
  expect_value({PlaneKind::kGlossyHitDistance, {}}, -1, "negative");
}

TEST(ValueMistakes, NegativeRadianceIsNamed) {
  expect_finding(room(), "indirect", "negative", [](Frame& f) {
    change_values(f, {PlaneKind::kIndirect, {}},
                  [](float value, int x, int, int) { return x % 8 == 0 ? -1.0f : value; });
  });
}

TEST(ValueMistakes, VisibilityAndRoughnessInPercentAreNamed) {
  expect_finding(room(), "light0.visibility", "above-one", [](Frame& f) {
    change_values(f, PlaneId::of_light(PlaneKind::kVisibility, 0),
                  [](float value, int, int, int) { return value * 255; });
  });
  expect_finding(room(), "roughness", "above-one", [](Frame& f) {
    change_values(f, {PlaneKind::kRoughness, {}},
                  [](float value, int, int, int) { return value * 100; });
  });
}

TEST(ValueMistakes, IdsThatAreNoIdsAreNamed) {
  const auto expect_ids = [](const std::string& mistake, auto change) {
    expect_finding(room(), "objectId", mistake, [&](Frame& f) {
      const auto ids = f.planes.find({PlaneKind::kObjectId, {}})->ids();
      for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) ids.at(x, y) = change(ids.at(x, y));
    });
  };
  expect_ids("id-saturated", [](std::uint32_t) { return 0xFFFFFFFFu; });
  expect_ids("id-float-bits",
             [](std::uint32_t id) { return std::bit_cast<std::uint32_t>(float(id)); });
  expect_ids("id-unknown", [](std::uint32_t) { return 12u; });
}

TEST(ValueMistakes, TheReportIsReadableByMachines) {
  Sequence bad = room().copy();
  for (Frame& f : bad.frames) f.camera.clip_from_view[1][1] *= -1;
  const auto json = report_json(bad.check());
  EXPECT_EQ(json["frames"], 4);
  EXPECT_EQ(json["checks"][3]["check"], "camera");
  EXPECT_EQ(json["checks"][3]["verdict"], "wrong");
  ASSERT_EQ(json["findings"].size(), 1u);
  EXPECT_EQ(json["findings"][0]["mistake"], "clip-flipped-y");
  for (const char* key : {"thing", "rule", "evidence"})
    EXPECT_FALSE(json["findings"][0][key].get<std::string>().empty()) << key;
}

}  // namespace
}  // namespace holdfast::check::test
