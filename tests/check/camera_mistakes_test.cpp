#include <cmath>

#include "tests/check/checked.h"

namespace holdfast::check::test {
namespace {

TEST(CameraMistakes, MatricesWrittenColumnByColumnAreNamed) {
  expect_finding(room(), "camera.viewFromWorld", "transposed", [](Frame& f) {
    f.camera.view_from_world = glm::transpose(f.camera.view_from_world);
  });
  expect_finding(room(), "camera.clipFromView", "transposed", [](Frame& f) {
    f.camera.clip_from_view = glm::transpose(f.camera.clip_from_view);
  });
  expect_finding(room(), "objects", "transposed", [](Frame& f) {
    for (auto& [id, matrix] : f.objects) matrix = glm::transpose(matrix);
  });
  expect_finding(room(), "lights", "transposed", [](Frame& f) {
    for (auto& [id, matrix] : f.lights) matrix = glm::transpose(matrix);
  });
}

TEST(CameraMistakes, AllMatricesTransposedAreNamedOneByOne) {
  Sequence bad = room().copy();
  for (Frame& f : bad.frames) {
    f.camera.view_from_world = glm::transpose(f.camera.view_from_world);
    f.camera.clip_from_view = glm::transpose(f.camera.clip_from_view);
    for (auto& [id, matrix] : f.objects) matrix = glm::transpose(matrix);
    for (auto& [id, matrix] : f.lights) matrix = glm::transpose(matrix);
  }
  EXPECT_EQ(mistakes(bad.check()), std::vector<std::string>(4, "transposed"));
}

TEST(CameraMistakes, TheInverseViewMatrixIsNamed) {
  expect_finding(room(), "camera.viewFromWorld", "view-inverse", [](Frame& f) {
    f.camera.view_from_world = glm::inverse(f.camera.view_from_world);
  });
}

TEST(CameraMistakes, TransposedAndInverseAreBothNamed) {
  Sequence bad = room().copy();
  for (Frame& f : bad.frames)
    f.camera.view_from_world = glm::transpose(glm::inverse(f.camera.view_from_world));
  EXPECT_EQ(mistakes(bad.check()), (std::vector<std::string>{"transposed", "view-inverse"}));
}

TEST(CameraMistakes, AFlippedYInClipSpaceIsNamed) {
  expect_finding(room(), "camera.clipFromView", "clip-flipped-y",
                 [](Frame& f) { f.camera.clip_from_view[1][1] *= -1; });
}

TEST(CameraMistakes, ClipConventionsOfZDoNotMatter) {
  Sequence other = room().copy();
  for (Frame& f : other.frames) {
    f.camera.clip_from_view[2][2] = 0;  // infinite far plane, reversed
    f.camera.clip_from_view[3][2] = 0.1;
  }
  EXPECT_EQ(mistakes(other.check()), std::vector<std::string>());
}

/// Depth as another reading has it, of each pixel's planar depth.
void expect_depth(const std::string& mistake,
                  const std::function<double(const Frame&, double, double)>& from_planar) {
  expect_finding(room(), "depth.Z", mistake, [&](Frame& f) {
    const ViewGeometry view(f.camera, kWidth, kHeight);
    change_values(f, {PlaneKind::kDepth, {}}, [&](float value, int x, int y, int) {
      if (!is_surface(value)) return value;
      const double along = glm::length(view.rays.position(x + 0.5, y + 0.5, 1.0));
      return float(from_planar(f, double(value), along));
    });
  });
}

double device(const Frame& f, double planar) {
  const glm::dvec4 clip = f.camera.clip_from_view * glm::dvec4(0, 0, -planar, 1);
  return clip.z / clip.w;
}

TEST(CameraMistakes, DepthThatIsNotPlanarIsNamed) {
  expect_depth("depth-along-ray",
               [](const Frame&, double planar, double along) { return planar * along; });
  expect_depth("depth-device",
               [](const Frame& f, double planar, double) { return device(f, planar); });
  expect_depth("depth-device-reversed",
               [](const Frame& f, double planar, double) { return 1 - device(f, planar); });
  expect_depth("depth-window",
               [](const Frame& f, double planar, double) { return (device(f, planar) + 1) / 2; });
  expect_depth("depth-window-reversed",
               [](const Frame& f, double planar, double) { return (1 - device(f, planar)) / 2; });
}

TEST(CameraMistakes, DepthInAnotherUnitIsNamed) {
  expect_depth("depth-centimetres",
               [](const Frame&, double planar, double) { return planar * 100; });
  expect_depth("depth-millimetres",
               [](const Frame&, double planar, double) { return planar * 1000; });
}

TEST(CameraMistakes, NormalsOfAnotherSpaceSideOrRangeAreNamed) {
  const auto expect_normal = [](const std::string& mistake, auto change) {
    expect_finding(room(), "normal.X/Y/Z", mistake, [&](Frame& f) {
      const glm::dmat3 view(f.camera.view_from_world);
      change_vectors(f, PlaneKind::kNormal, [&](glm::dvec3 n) { return change(view, n); });
    });
  };
  using Mat = const glm::dmat3&;
  expect_normal("normal-view-space", [](Mat view, glm::dvec3 n) { return view * n; });
  expect_normal("normal-away", [](Mat, glm::dvec3 n) { return -n; });
  expect_normal("normal-view-space-away", [](Mat view, glm::dvec3 n) { return -(view * n); });
  expect_normal("normal-encoded", [](Mat, glm::dvec3 n) { return n * 0.5 + 0.5; });
  expect_normal("normal-encoded-view-space",
                [](Mat view, glm::dvec3 n) { return view * n * 0.5 + 0.5; });
  expect_normal("normal-length", [](Mat, glm::dvec3 n) { return n * 0.9; });
}

TEST(CameraMistakes, NormalsOfOneObjectThatFaceAwayAreNamed) {
  expect_finding(room(), "normal.X/Y/Z", "normal-facing-away", [](Frame& f) {
    const auto ids = f.planes.at({PlaneKind::kObjectId, {}}).ids();
    change_values(f, {PlaneKind::kNormal, {}}, [&](float value, int x, int y, int) {
      return ids.at(x, y) == 2 ? -value : value;
    });
  });
}

TEST(CameraMistakes, ViewSpaceNormalsAreSeenWithoutAnyMotion) {
  Sequence still = room().copy();
  still.frames.resize(1);
  expect_finding(still, "normal.X/Y/Z", "normal-view-space", [](Frame& f) {
    const glm::dmat3 view(f.camera.view_from_world);
    change_vectors(f, PlaneKind::kNormal, [&](glm::dvec3 n) { return view * n; });
  });
}

TEST(CameraMistakes, TwoMistakesAreBothNamed) {
  Sequence bad = room().copy();
  for (Frame& f : bad.frames) {
    const glm::dmat3 view(f.camera.view_from_world);
    change_vectors(f, PlaneKind::kNormal, [&](glm::dvec3 n) { return view * n; });
    f.camera.view_from_world = glm::inverse(f.camera.view_from_world);
  }
  const Report report = bad.check();
  EXPECT_EQ(mistakes(report), (std::vector<std::string>{"view-inverse", "normal-view-space"}))
      << report_text(report);
}

}  // namespace
}  // namespace holdfast::check::test
