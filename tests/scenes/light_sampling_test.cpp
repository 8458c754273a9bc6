// Samples of lights for irradiance: uniform in solid angle near a rectangle.

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "client/scenes/light_target.h"
#include "client/scenes/rng.h"
#include "client/scenes/sampling.h"
#include "client/scenes/spherical_rectangle.h"
#include "tests/scenes/small_scenes.h"

namespace holdfast::scenes {
namespace {

/// The solid angle of a rectangle by the formula for one corner below the origin, added up.
double corner_solid_angle(double x, double y, double h) {
  return std::atan(x * y / (h * std::sqrt(x * x + y * y + h * h)));
}

TEST(SphericalRectangle, HasTheSolidAngleOfItsCorners) {
  Rng rng(3, 1, 4, 1);
  for (int i = 0; i < 1000; ++i) {
    const double x0 = 4.0 * rng.next() - 2.0, x1 = x0 + 0.1 + rng.next();
    const double y0 = 4.0 * rng.next() - 2.0, y1 = y0 + 0.1 + rng.next();
    const double h = std::pow(10.0, 1.0 - 5.0 * rng.next());
    const double expected = corner_solid_angle(x1, y1, h) - corner_solid_angle(x0, y1, h) -
                            corner_solid_angle(x1, y0, h) + corner_solid_angle(x0, y0, h);
    EXPECT_NEAR(SphericalRectangle(x0, x1, y0, y1, h).solid_angle(), expected, 1e-11);
  }
}

TEST(SphericalRectangle, SharesOutItsSolidAngleEvenly) {
  const double x0 = -0.3, x1 = 0.9, y0 = -1.1, y1 = 0.2, h = 0.15;
  const SphericalRectangle whole(x0, x1, y0, y1, h);
  for (const double u : {0.1, 0.35, 0.8}) {
    // Points with the same u lie on one line of equal x: what is left of it is a rectangle, too.
    const double x = whole.at({u, 0.4}).x;
    EXPECT_NEAR(whole.at({u, 0.9}).x, x, 1e-12);
    EXPECT_NEAR(SphericalRectangle(x0, x, y0, y1, h).solid_angle(), u * whole.solid_angle(), 1e-9);
  }
}

TEST(SphericalRectangle, StaysInItsBoundsAtItsCorners) {
  for (const double h : {1e-6, 0.1, 100.0}) {
    const SphericalRectangle seen(0.0, 1.0, -0.5, 0.5, h);
    for (const double u : {0.0, 1.0})
      for (const double v : {0.0, 1.0}) {
        const glm::dvec2 p = seen.at({u, v});
        EXPECT_NEAR(p.x, u, 1e-3) << h;
        EXPECT_NEAR(p.y, v - 0.5, 1e-3) << h;
      }
  }
}

// At every distance, on both sides of the change from area to solid angle.
TEST(SampleIrradiance, MeansMeetLambertsFormula) {
  const Scene scene = floor_and_box(rectangle_light(), {0.3, 1.5, -0.2});
  const LightState light = lights_at(scene, 0.0).front();
  const glm::dvec3 normal = glm::normalize(glm::dvec3(0.3, 0.9, -0.1));
  for (const double y : {1.49, 1.4, 1.0, 0.2, -0.6, -3.0}) {
    const glm::dvec3 point(0.1, y, 0.05);
    double sum = 0.0, highest = 0.0;
    constexpr int kSide = 300;
    for (int i = 0; i < kSide * kSide; ++i) {
      const LightSample s =
          sample_irradiance_of(light, point, stratified(i, kSide, glm::dvec2(0.5)));
      const double value = std::max(0.0, glm::dot(normal, s.direction)) * s.geometry;
      sum += value;
      highest = std::max(highest, value);
    }
    const double truth = rectangle_irradiance(light, point, normal);
    EXPECT_NEAR(sum / (kSide * kSide), truth, 2e-3 * truth + 1e-6) << y;
    EXPECT_LT(highest, 2.0 * std::numbers::pi) << "bounded, however near";
  }
}

TEST(SampleIrradiance, IsNothingBehindTheLight) {
  const Scene scene = floor_and_box(rectangle_light(), {0.0, 2.0, 0.0});
  const LightState light = lights_at(scene, 0.0).front();
  EXPECT_EQ(sample_irradiance_of(light, {0.0, 2.1, 0.0}, {0.5, 0.5}).geometry, 0.0);
}

// A ray may meet a surface anywhere: no path of the room may be a firefly.
TEST(BuiltinScenes, RoomHasNoSamplesFarAboveTheRest) {
  RenderSettings settings = small_settings(160, 90);
  settings.gradients = false;
  Renderer renderer(room_scene(), settings);
  const Frame frame = renderer.frame(12);
  for (const PlaneKind kind : {PlaneKind::kGlossy, PlaneKind::kIndirect})
    for (int y = 0; y < 90; ++y)
      for (int x = 0; x < 160; ++x)
        EXPECT_LT(luminance(colour_at(frame.planes, kind, x, y)), 5.0) << x << ' ' << y;
}

}  // namespace
}  // namespace holdfast::scenes
