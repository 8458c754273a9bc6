#include <cmath>
#include <limits>

#include "tests/check/checked.h"

namespace holdfast::check::test {
namespace {

PlaneId of_light(PlaneKind kind) { return PlaneId::of_light(kind, 0); }

/// The same world with Z upwards.
Sequence turned(const Sequence& y_up) {
  const glm::dmat3 turn(1, 0, 0, 0, 0, 1, 0, -1, 0);
  Sequence out = y_up.copy();
  for (Frame& f : out.frames) {
    f.camera.view_from_world = f.camera.view_from_world * glm::dmat4(glm::transpose(turn));
    for (TransformTable* table : {&f.objects, &f.lights})
      for (auto& [id, matrix] : *table) matrix = glm::dmat4(turn) * matrix;
    for (const PlaneKind kind :
         {PlaneKind::kNormal, PlaneKind::kGlossyDirection, PlaneKind::kIndirectDirection})
      change_vectors(f, kind, [&](glm::dvec3 v) { return turn * v; });
  }
  return out;
}

TEST(LightMistakes, AWorldWithZUpwardsIsNoMistake) {
  const Report report = turned(room()).check();
  EXPECT_EQ(mistakes(report), std::vector<std::string>()) << report_text(report);
}

TEST(LightMistakes, ABlockerBeyondTheLightIsNamed) {
  expect_finding(room(), "light0.blockerDistance", "blocker-beyond-light", [](Frame& f) {
    change_values(f, of_light(PlaneKind::kBlockerDistance),
                  [](float value, int, int, int) { return value * 100; });
  });
}

TEST(LightMistakes, BlockersThatFloatAreNamed) {
  // Distances from the camera's side of the light: 0.3 m short of the blocker.
  expect_finding(room(), "light0.blockerDistance", "blocker-floating", [](Frame& f) {
    change_values(f, of_light(PlaneKind::kBlockerDistance),
                  [](float value, int, int, int) { return value * 0.3f; });
  });
}

TEST(LightMistakes, BlockedYetVisibleIsNamed) {
  expect_finding(room(), "light0.visibility", "blocked-yet-visible", [](Frame& f) {
    change_values(f, of_light(PlaneKind::kVisibility), [](float, int, int, int) { return 1.0f; });
  });
}

TEST(LightMistakes, UnblockedYetDarkIsNamed) {
  expect_finding(room(), "light0.visibility", "unblocked-yet-dark", [](Frame& f) {
    change_values(f, of_light(PlaneKind::kVisibility),
                  [](float value, int x, int, int) { return x % 4 == 0 ? 0.0f : value; });
  });
}

TEST(LightMistakes, ShadowInPlaceOfVisibilityIsNamed) {
  expect_finding(room(), "light0.visibility", "visibility-inverted", [](Frame& f) {
    change_values(f, of_light(PlaneKind::kVisibility),
                  [](float value, int, int, int) { return 1 - value; });
  });
}

TEST(LightMistakes, SamplesOutsideTheLightAreNamed) {
  expect_finding(room(), "light0.sampleU/V", "sample-range", [](Frame& f) {
    change_values(f, of_light(PlaneKind::kLightSample),
                  [](float value, int, int, int) { return value * 2 - 1; });
  });
}

TEST(LightMistakes, TheInverseMatrixOfALightIsNamed) {
  expect_finding(room(), "lights.0", "light-inverse", [](Frame& f) {
    for (auto& [id, matrix] : f.lights) matrix = glm::inverse(matrix);
  });
}

TEST(LightMistakes, ALightThatEmitsAlongItsZIsNamed) {
  expect_finding(room(), "lights.0", "light-backwards", [](Frame& f) {
    for (auto& [id, matrix] : f.lights) {
      matrix[0] *= -1;  // turned by half a circle about y; the lamp is the same from outside
      matrix[2] *= -1;
    }
  });
}

TEST(RayMistakes, GlossyDirectionsOfAnotherSideSpaceOrLengthAreNamed) {
  const auto expect_direction = [](PlaneKind kind, const std::string& thing,
                                   const std::string& mistake, auto change) {
    expect_finding(room(), thing, mistake, [&](Frame& f) {
      const glm::dmat3 view(f.camera.view_from_world);
      change_vectors(f, kind, [&](glm::dvec3 d) { return change(view, d); });
    });
  };
  using Mat = const glm::dmat3&;
  for (const auto& [kind, thing] :
       {std::pair{PlaneKind::kGlossyDirection, "glossy.direction.X/Y/Z"},
        std::pair{PlaneKind::kIndirectDirection, "indirect.direction.X/Y/Z"}}) {
    expect_direction(kind, thing, "direction-reversed", [](Mat, glm::dvec3 d) { return -d; });
    expect_direction(kind, thing, "direction-length", [](Mat, glm::dvec3 d) { return d * 3.0; });
  }
}

/// Where view space is far from world space: the camera looks along the world's Y.
TEST(RayMistakes, DirectionsInViewSpaceAreNamed) {
  for (const auto& [kind, thing] :
       {std::pair{PlaneKind::kGlossyDirection, "glossy.direction.X/Y/Z"},
        std::pair{PlaneKind::kIndirectDirection, "indirect.direction.X/Y/Z"}}) {
    Sequence z_up = turned(room());
    expect_finding(z_up, thing, "direction-view-space", [&](Frame& f) {
      const glm::dmat3 view(f.camera.view_from_world);
      change_vectors(f, kind, [&](glm::dvec3 d) { return view * d; });
    });
  }
}

TEST(RayMistakes, DirectionsBelowTheHorizonAreNamed) {
  expect_finding(room(), "glossy.direction.X/Y/Z", "direction-below-horizon", [](Frame& f) {
    change_values(f, {PlaneKind::kGlossyDirection, {}},
                  [](float value, int x, int, int) { return x % 4 == 0 ? -value : value; });
  });
}

TEST(RayMistakes, HitsThatFloatAreNamed) {
  expect_finding(room(), "glossy.hitDistance", "hit-floating", [](Frame& f) {
    change_values(f, {PlaneKind::kGlossyHitDistance, {}},
                  [](float value, int, int, int) { return value * 0.2f; });
  });
}

}  // namespace
}  // namespace holdfast::check::test
