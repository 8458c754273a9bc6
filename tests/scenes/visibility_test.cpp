// The estimator of visibility: noisy, converged and brute force must agree.

#include <cmath>

#include <gtest/gtest.h>

#include "client/scenes/glossy.h"
#include "client/scenes/light_target.h"
#include "client/scenes/sampling.h"
#include "client/scenes/shadow_ray.h"
#include "tests/scenes/small_scenes.h"

namespace holdfast::scenes {
namespace {

/// Means of many noisy frames against the reference. With V in {0,1} the variance is known, so the
/// sum of squared errors in standard deviations follows chi^2 with one degree of freedom a pixel.
void expect_noisy_mean_meets_reference(Scene scene) {
  scene.components = {true, false, false};
  StillView still(std::move(scene));
  constexpr int kFrames = 300;
  const PlaneSet reference = render_reference(still.view, 2304);
  const auto truth = reference.at(of_light(PlaneKind::kVisibility)).channel(0);
  Channels<float> sum(truth.width, truth.height, 1);
  for (int i = 0; i < kFrames; ++i) {
    View view = still.view;
    view.frame = i;
    const PlaneSet noisy = render_noisy(view, 1);
    const auto v = noisy.at(of_light(PlaneKind::kVisibility)).channel(0);
    for (int y = 0; y < v.height; ++y)
      for (int x = 0; x < v.width; ++x) {
        ASSERT_TRUE(v.at(x, y) == 0.0f || v.at(x, y) == 1.0f);
        sum[0].at(x, y) += v.at(x, y);
      }
  }
  double chi2 = 0.0, bias = 0.0;
  int penumbra = 0;
  for (int y = 0; y < truth.height; ++y) {
    for (int x = 0; x < truth.width; ++x) {
      const auto p = static_cast<double>(truth.at(x, y));
      const double error = static_cast<double>(sum[0].at(x, y)) / kFrames - p;
      if (p < 0.02 || p > 0.98) {
        EXPECT_LT(std::abs(error), 0.04) << x << ' ' << y;
        continue;
      }
      chi2 += error * error / (p * (1.0 - p) / kFrames);
      bias += error;
      ++penumbra;
    }
  }
  ASSERT_GT(penumbra, 40);
  const double spread = std::sqrt(2.0 / penumbra);
  EXPECT_NEAR(chi2 / penumbra, 1.0, 5.0 * spread);
  EXPECT_NEAR(bias / penumbra, 0.0, 5.0 * 0.5 / std::sqrt(1.0 * kFrames * penumbra));
}

TEST(NoisyVisibility, MeanMeetsTheReferenceUnderARectangle) {
  expect_noisy_mean_meets_reference(floor_and_box(rectangle_light(), {0.8, 2.2, -1.0}));
}

TEST(NoisyVisibility, MeanMeetsTheReferenceUnderALightCloseToTheFloor) {
  const Light wide{.id = 3, .shape = LightShape::kRectangle, .width = 3.0, .height = 2.0};
  expect_noisy_mean_meets_reference(floor_and_box(wide, {1.2, 1.3, -0.8}));
}

TEST(NoisyVisibility, MeanMeetsTheReferenceOnAGlossyFloor) {
  const Material shiny{.albedo = glm::dvec3(0.1), .roughness = 0.4, .specular = glm::dvec3(0.8)};
  expect_noisy_mean_meets_reference(floor_and_box(rectangle_light(), {0.3, 2.0, -1.5}, shiny));
}

TEST(NoisyVisibility, MeanMeetsTheReferenceUnderASphere) {
  const Light sphere{.id = 3, .shape = LightShape::kSphere, .radius = 0.5};
  expect_noisy_mean_meets_reference(floor_and_box(sphere, {0.6, 2.0, -0.8}));
}

TEST(NoisyVisibility, MeanMeetsTheReferenceUnderADisk) {
  const Light disk{.id = 3, .shape = LightShape::kDisk, .radius = 0.6};
  expect_noisy_mean_meets_reference(floor_and_box(disk, {0.6, 2.0, -0.8}));
}

TEST(NoisyVisibility, MeanMeetsTheReferenceUnderASun) {
  const Light sun{.id = 3, .shape = LightShape::kDirectional, .radius = 0.3};
  Scene scene = floor_and_box(sun, {0.0, 0.0, 0.0});
  // Local +Z points towards the sun.
  scene.lights[0].motion = Motion(look_at({0.5, 2.0, -1.0}, {0.0, 0.0, 0.0}));
  expect_noisy_mean_meets_reference(scene);
}

// One uniform light sample at a time, in double precision, without any of the machinery: the
// shadowed light itself, which must equal unshadowed * visibility.
TEST(ReferenceVisibility, TimesUnshadowedIsTheBruteForceShadowedLight) {
  const Material shiny{.albedo = {0.3, 0.2, 0.1}, .roughness = 0.5, .specular = glm::dvec3(0.4)};
  Scene scene = floor_and_box(rectangle_light(), {0.3, 2.0, -1.5}, shiny);
  scene.components = {true, false, false};
  StillView still(std::move(scene), 16, 12);
  const PlaneSet reference = render_reference(still.view, 2304);
  const LightState& light = still.view.lights[0];
  constexpr int kSide = 100;
  for (int y = 0; y < 12; ++y) {
    for (int x = 0; x < 16; ++x) {
      const auto primary = primary_at(still.view, x, y);
      if (!primary) continue;
      const Surface& s = primary->surface;
      double shadowed = 0.0, unshadowed = 0.0;
      for (int i = 0; i < kSide * kSide; ++i) {
        const LightSample sample =
            sample_light(light, s.position, stratified(i, kSide, glm::dvec2(0.5)));
        const double cosine = std::max(0.0, glm::dot(s.normal, sample.direction));
        const glm::dvec3 brdf =
            s.albedo * std::numbers::inv_pi + evaluate_lobe(s, sample.direction, s.roughness);
        const double f = luminance(brdf * light.emission) * cosine * sample.geometry;
        const ShadowRay ray = shadow_ray(s, sample);
        unshadowed += f;
        if (!still.world.occluded(s.origin, ray.direction, ray.length_m)) shadowed += f;
      }
      const double mine = luminance(LightTarget(light, s).unshadowed());
      const auto v =
          static_cast<double>(reference.at(of_light(PlaneKind::kVisibility)).channel(0).at(x, y));
      EXPECT_NEAR(mine, unshadowed / (kSide * kSide), 0.01 * mine) << x << ' ' << y;
      EXPECT_NEAR(v * mine, shadowed / (kSide * kSide), 0.015 * mine) << x << ' ' << y;
    }
  }
}

TEST(RectangleIrradiance, MeetsBruteForceQuadrature) {
  const Light shape = rectangle_light();
  const glm::dvec3 normals[] = {
      {0, 1, 0}, {0.6, 0.8, 0}, {0, 0.1, 0.995}, {-0.9, 0.3, -0.3}, {0.1, -0.5, -0.8}};
  for (const glm::dvec3& eye : {glm::dvec3(0.2, 1.5, 0.4), glm::dvec3(2.0, 0.3, -1.0)}) {
    Scene scene = floor_and_box(shape, eye);
    const LightState light = lights_at(scene, 0.0).front();
    for (const glm::dvec3& n : normals) {
      const glm::dvec3 normal = glm::normalize(n), point(0.1, 0.0, -0.2);
      double sum = 0.0;
      constexpr int kSide = 600;
      for (int i = 0; i < kSide * kSide; ++i) {
        const LightSample s = sample_light(light, point, stratified(i, kSide, glm::dvec2(0.5)));
        sum += std::max(0.0, glm::dot(normal, s.direction)) * s.geometry;
      }
      EXPECT_NEAR(rectangle_irradiance(light, point, normal), sum / (kSide * kSide), 1e-5);
    }
  }
}

TEST(RectangleIrradiance, IsZeroBehindTheLight) {
  const Scene scene = floor_and_box(rectangle_light(), {0.0, 2.0, 0.0});
  const LightState light = lights_at(scene, 0.0).front();
  EXPECT_EQ(rectangle_irradiance(light, {0.0, 3.0, 0.0}, {0.0, -1.0, 0.0}), 0.0);
}

TEST(NoisyVisibility, IsOneWhereTheLightDoesNotReach) {
  // The light lies below the floor.
  StillView still(floor_and_box(rectangle_light(), {0.0, -2.0, 0.0}));
  const PlaneSet planes = render_noisy(still.view, 1);
  const auto v = planes.at(of_light(PlaneKind::kVisibility)).channel(0);
  const auto d = planes.at(of_light(PlaneKind::kBlockerDistance)).channel(0);
  const auto ids = planes.at({PlaneKind::kObjectId, {}}).ids();
  for (int y = 0; y < v.height; ++y) {
    for (int x = 0; x < v.width; ++x) {
      if (ids.at(x, y) != 7) continue;
      EXPECT_EQ(v.at(x, y), 1.0f);
      EXPECT_EQ(d.at(x, y), std::numeric_limits<float>::infinity());
      EXPECT_EQ(planes.at(of_light(PlaneKind::kUnshadowed)).channel(0).at(x, y), 0.0f);
    }
  }
}

TEST(NoisyVisibility, UnshadowedDoesNotChangeWithTheSeed) {
  StillView still(floor_and_box(rectangle_light(), {0.8, 2.2, -1.0}));
  View other = still.view;
  other.seed = 99;
  const PlaneSet a = render_noisy(still.view, 1), b = render_noisy(other, 1);
  int differing = 0;
  for (int y = 0; y < 30; ++y) {
    for (int x = 0; x < 40; ++x) {
      const PlaneId unshadowed = of_light(PlaneKind::kUnshadowed);
      EXPECT_EQ(a.at(unshadowed).channel(1).at(x, y), b.at(unshadowed).channel(1).at(x, y));
      const PlaneId sample = of_light(PlaneKind::kLightSample);
      differing += a.at(sample).channel(0).at(x, y) != b.at(sample).channel(0).at(x, y);
    }
  }
  EXPECT_GT(differing, 500);
}

}  // namespace
}  // namespace holdfast::scenes
