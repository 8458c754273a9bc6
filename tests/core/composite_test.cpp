#include "core/denoiser/composite.h"

#include <vector>

#include <gtest/gtest.h>

#include "tests/core/denoiser_world.h"

namespace holdfast {
namespace {

/// One pixel of surface and one of sky.
struct Composite {
  Guides guides = test::wall(test::perspective_camera(2, 1), 2, 1);
  PlaneSet input, shaded, results;

  Composite() { test::set_pixel(guides, 1, 0, 0.0f, glm::vec3(0)); }
  static void set(PlaneSet& set, PlaneId id, glm::vec3 value) {
    Plane& plane = set.add(id, 2, 1);
    for (int c = 0; c < plane.channels(); ++c) test::fill(plane.channel(c), value[c]);
  }
  glm::vec3 at(int x) {
    std::vector<PlaneId> signals;
    for (const Plane& plane : results)
      if (plane.id() != test::kCompositePlane) signals.push_back(plane.id());
    EXPECT_EQ(compose(guides, signals, input, shaded, results), 0u);
    const Plane& out = results.at(test::kCompositePlane);
    return {out.channel(0).at(x, 0), out.channel(1).at(x, 0), out.channel(2).at(x, 0)};
  }
};

void expect_near(glm::vec3 a, glm::vec3 b) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], 1e-6f) << c;
}

TEST(Composite, IsTheSumOfAllComponentsTimesTheirFactors) {
  Composite c;
  c.set(c.input, test::of_light(PlaneKind::kUnshadowed, 0), {1, 2, 3});
  c.set(c.results, test::of_light(PlaneKind::kVisibility, 0), glm::vec3(0.5f));
  c.set(c.input, test::of_light(PlaneKind::kUnshadowed, 7), {0.1f, 0.1f, 0.1f});
  c.set(c.results, test::of_light(PlaneKind::kVisibility, 7), glm::vec3(1));
  c.set(c.input, {PlaneKind::kSpecular, {}}, {0.5f, 0.5f, 0.25f});
  c.set(c.results, test::kGlossyPlane, {2, 4, 8});
  c.set(c.input, {PlaneKind::kAlbedo, {}}, {0.1f, 0.2f, 0.3f});
  c.set(c.results, test::kIndirectPlane, {1, 1, 2});
  c.set(c.input, {PlaneKind::kEmission, {}}, {10, 20, 30});
  expect_near(c.at(0), {0.5f + 0.1f + 1.0f + 0.1f + 10, 1.0f + 0.1f + 2.0f + 0.2f + 20,
                        1.5f + 0.1f + 2.0f + 0.6f + 30});
  expect_near(c.at(1), {10, 20, 30});  // sky is emission alone
}

TEST(Composite, AbsentAlbedoAndSpecularCountAsOne) {
  Composite c;
  c.set(c.results, test::kGlossyPlane, {2, 4, 8});
  c.set(c.results, test::kIndirectPlane, {1, 1, 2});
  expect_near(c.at(0), {3, 5, 10});
  expect_near(c.at(1), glm::vec3(0));
}

TEST(Composite, VisibilityWithoutUnshadowedLightAddsNothing) {
  Composite c;
  c.set(c.results, test::of_light(PlaneKind::kVisibility, 0), glm::vec3(1));
  expect_near(c.at(0), glm::vec3(0));
}

TEST(Composite, FactorsThatAreNotFiniteCountAsZero) {
  for (const float bad : {test::kNaN, test::kInf, -test::kInf}) {
    Composite c;
    c.set(c.input, {PlaneKind::kAlbedo, {}}, glm::vec3(bad));
    c.set(c.results, test::kIndirectPlane, {1, 1, 2});
    c.set(c.input, {PlaneKind::kEmission, {}}, {1, bad, 3});
    expect_near(c.at(0), {1, 0, 3});
    expect_near(c.at(1), {1, 0, 3});
  }
}

}  // namespace
}  // namespace holdfast
