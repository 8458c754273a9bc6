#include "tests/check/checked.h"

namespace holdfast::check::test {
namespace {

void expect_motion(const std::string& mistake,
                   const std::function<glm::dvec2(glm::dvec2)>& change) {
  expect_finding(room(), "motion.X/Y", mistake, [&](Frame& f) {
    Plane& plane = *f.planes.find({PlaneKind::kMotion, {}});
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        float &mx = plane.channel(0).at(x, y), &my = plane.channel(1).at(x, y);
        const glm::dvec2 m = change({double(mx), double(my)});
        mx = float(m.x);
        my = float(m.y);
      }
  });
}

TEST(MotionMistakes, SignUnitAxesAndOrderAreNamed) {
  const glm::dvec2 size(kWidth, kHeight);
  expect_motion("motion-sign", [](glm::dvec2 m) { return -m; });
  expect_motion("motion-normalised", [&](glm::dvec2 m) { return m / size; });
  expect_motion("motion-ndc", [&](glm::dvec2 m) { return m / size * glm::dvec2(2, -2); });
  expect_motion("motion-flipped-y", [](glm::dvec2 m) { return m * glm::dvec2(1, -1); });
  expect_motion("motion-swapped", [](glm::dvec2 m) { return glm::dvec2(m.y, m.x); });
}

TEST(MotionMistakes, SeveralAtOnceAreNamedTogether) {
  const glm::dvec2 size(kWidth, kHeight);
  expect_motion("motion-sign+motion-normalised", [&](glm::dvec2 m) { return -m / size; });
  expect_motion("motion-sign+motion-ndc",
                [&](glm::dvec2 m) { return m / size * glm::dvec2(-2, 2); });
}

TEST(MotionMistakes, MotionThatNothingExplainsIsUnclear) {
  Sequence bad = room().copy();
  for (Frame& f : bad.frames)
    change_values(f, {PlaneKind::kMotion, {}}, [](float value, int x, int y, int c) {
      return value + float((x * 7 + y * 5 + c * 3) % 11);
    });
  const Report report = bad.check();
  EXPECT_EQ(mistakes(report), std::vector<std::string>()) << report_text(report);
  EXPECT_EQ(verdict(report, "motion"), Verdict::kUnclear) << report_text(report);
}

TEST(MotionMistakes, InverseMatricesOfObjectsAreNamed) {
  expect_finding(room(), "objects", "object-inverse", [](Frame& f) {
    for (auto& [id, matrix] : f.objects) matrix = glm::inverse(matrix);
    f.planes.remove({PlaneKind::kMotion, {}});
  });
}

TEST(MotionMistakes, AnObjectThatMovesWithoutATableIsNamed) {
  expect_finding(room(), "objects.7", "object-missing", [](Frame& f) {
    f.objects.erase(7);
    f.planes.remove({PlaneKind::kMotion, {}});
  });
}

TEST(MotionMistakes, AnObjectThatOnlyMotionVectorsDescribeIsNoMistake) {
  Sequence deforming = room().copy();
  for (Frame& f : deforming.frames) f.objects.erase(7);
  const Report report = deforming.check();
  EXPECT_EQ(mistakes(report), std::vector<std::string>()) << report_text(report);
}

}  // namespace
}  // namespace holdfast::check::test
