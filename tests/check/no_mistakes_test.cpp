#include <cmath>

#include "tests/check/checked.h"

namespace holdfast::check::test {
namespace {

TEST(NoMistakes, ARoomWhereEverythingMovesIsRightInEveryCheck) {
  const Report report = room().check();
  EXPECT_EQ(report.frames, 4);
  EXPECT_EQ(mistakes(report), std::vector<std::string>()) << report_text(report);
  for (const Line& line : report.lines) EXPECT_EQ(line.verdict, Verdict::kOk) << line.check;
  EXPECT_EQ(report.lines.size(), 10u) << report_text(report);
}

TEST(NoMistakes, StillAndMovingScenesRaiseNoFalseAlarm) {
  for (const char* scene : {"fence", "static", "cylinder", "glossy-floor", "occluder"}) {
    const Report report = rendered(scene, 3).check();
    EXPECT_EQ(mistakes(report), std::vector<std::string>()) << scene << '\n' << report_text(report);
  }
}

TEST(NoMistakes, ASceneAtRestIsNoEvidenceOnCameraObjectsAndMotion) {
  Sequence still = rendered("static", 3);
  add_motion(still);
  const Report report = still.check();
  for (const char* check : {"camera", "objects", "motion"})
    EXPECT_EQ(verdict(report, check), Verdict::kNoEvidence) << report_text(report);
  EXPECT_EQ(verdict(report, "normal"), Verdict::kOk);
}

TEST(NoMistakes, HalfPrecisionIsEnough) {
  // Values of 11 bits, as half floats have them.
  const auto rounded = [](float value, int, int, int) {
    int exponent = 0;
    const float mantissa = std::frexp(value, &exponent);
    return std::ldexp(std::round(mantissa * 2048) / 2048, exponent);
  };
  Sequence half = room().copy();
  for (Frame& frame : half.frames)
    for (const PlaneKind kind : {PlaneKind::kDepth, PlaneKind::kNormal, PlaneKind::kMotion})
      change_values(frame, {kind, {}}, rounded);
  const Report report = half.check();
  EXPECT_EQ(mistakes(report), std::vector<std::string>()) << report_text(report);
  EXPECT_EQ(verdict(report, "camera"), Verdict::kOk) << report_text(report);
  EXPECT_EQ(verdict(report, "motion"), Verdict::kOk) << report_text(report);
}

TEST(NoMistakes, NothingButDepthAndNormalIsEnough) {
  Sequence bare = room().copy();
  for (Frame& frame : bare.frames) {
    PlaneSet planes;
    for (const PlaneKind kind : {PlaneKind::kDepth, PlaneKind::kNormal})
      copy_plane(frame.planes.at({kind, {}}), planes);
    frame.planes = std::move(planes);
    frame.objects.clear();
    frame.lights.clear();
  }
  bare.lights.clear();
  const Report report = bare.check();
  EXPECT_EQ(mistakes(report), std::vector<std::string>()) << report_text(report);
  EXPECT_EQ(verdict(report, "camera"), Verdict::kOk) << report_text(report);
}

TEST(NoMistakes, FramesAcrossACutAreNotCompared) {
  Sequence cut = room().copy();
  for (std::size_t i = 1; i < cut.frames.size(); ++i) {
    cut.frames[i].cut = true;
    cut.frames[i].camera.view_from_world[3].x += double(i) * 10;  // it would not fit
    cut.frames[i].planes.remove({PlaneKind::kMotion, {}});
    // Only what one frame shows is judged, so that the light must come along.
    for (auto& [id, matrix] : cut.frames[i].lights)
      matrix[3] -=
          glm::inverse(cut.frames[i].camera.view_from_world) * glm::dvec4(double(i) * 10, 0, 0, 0);
  }
  const Report report = cut.check();
  EXPECT_EQ(mistakes(report), std::vector<std::string>()) << report_text(report);
  EXPECT_EQ(verdict(report, "camera"), Verdict::kNoEvidence);
}

TEST(NoMistakes, ASingleFrameIsJudgedByWhatItShows) {
  Sequence one = room().copy();
  one.frames.resize(1);
  const Report report = one.check();
  EXPECT_EQ(mistakes(report), std::vector<std::string>()) << report_text(report);
  EXPECT_EQ(verdict(report, "camera"), Verdict::kNoEvidence);
  EXPECT_EQ(verdict(report, "normal"), Verdict::kOk);
}

}  // namespace
}  // namespace holdfast::check::test
