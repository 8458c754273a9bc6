// Unshadowed light against the integral of the BRDF over the light.

#include <random>

#include <gtest/gtest.h>

#include "core/shading/direct_light.h"
#include "core/shading/ltc.h"
#include "tests/core/ltc_oracle.h"

namespace holdfast {
namespace {

using namespace test;

glm::dvec3 shade(const Light& light, const glm::dmat4& world_from_light,
                 const ShadingPoint<double>& point) {
  return unshadowed_light(place_light<double>(light, world_from_light), point);
}

ShadingPoint<double> point_of(const Glossy& material, double cosine) {
  ShadingPoint<double> point = point_seen_under(cosine);
  point.albedo = material.albedo;
  if (material.roughness == 0.0) return point;
  point.roughness = material.roughness;
  point.specular = directional_albedo(ltc_lobe(material.roughness, cosine), material.f0);
  return point;
}

/// Rectangles that meet the lobe of a point seen from +X under `cosine` in different ways: around
/// the mirror direction, beside it, overhead, across the horizon, near and large, and off the lobe.
std::vector<std::pair<Light, glm::dmat4>> rectangles(double cosine) {
  const glm::dvec3 mirror(-std::sqrt(1 - cosine * cosine), cosine, 0);
  const auto rectangle = [](double width, double height) {
    return unit_light(LightShape::kRectangle, width, height);
  };
  return {{rectangle(0.8, 0.5), aimed(2.0 * mirror)},
          {rectangle(0.5, 1.5), aimed(2.0 * mirror + glm::dvec3(0, 0.3, 0.6))},
          {rectangle(1.0, 1.0), aimed({0.3, 2.0, -0.5})},
          {rectangle(2.0, 2.0), aimed({-1.5, 0.1, 0.2}, {0, 0.2, 0})},
          {rectangle(3.0, 3.0), aimed({-0.4, 1.0, 0.1}, {0.2, 0, 0})},
          {rectangle(1.0, 0.4), aimed({1.5, 0.5, 1.0})}};
}

/// The largest error over `rectangles`, for lights of radiance 1.
double largest_error(const Glossy& material, double cosine) {
  const ShadingPoint<double> point = point_of(material, cosine);
  const int side = material.roughness > 0.2 ? 160 : 600;  // a cell is narrower than the highlight
  double worst = 0;
  for (const auto& [light, place] : rectangles(cosine)) {
    const glm::dvec3 truth = brute_force(light, place, material, point, side);
    worst = std::max(worst, std::abs(shade(light, place, point).x - truth.x));
  }
  return worst;
}

// The tolerance is the fit's own: a lobe of GGX is not quite a transformed cosine, least of all at
// grazing angles.
TEST(UnshadowedLight, OfAMetalIsTheIntegralOfItsBrdf) {
  const std::pair<double, double> tolerances[] = {
      {0.1, 0.05}, {0.3, 0.03}, {0.55, 0.02}, {0.8, 0.025}, {1.0, 0.01}};
  for (const double roughness : {0.15, 0.3, 0.5, 0.75, 1.0})
    for (const auto& [cosine, tolerance] : tolerances) {
      const Glossy metal{glm::dvec3(0), glm::dvec3(1), roughness};
      EXPECT_LT(largest_error(metal, cosine), tolerance) << roughness << ' ' << cosine;
    }
}

// Fresnel's term is taken as constant over the lobe, which costs more at grazing angles.
TEST(UnshadowedLight, OfADielectricIsTheIntegralOfItsBrdf) {
  const std::pair<double, double> tolerances[] = {
      {0.1, 0.06}, {0.3, 0.03}, {0.55, 0.01}, {0.8, 0.005}, {1.0, 0.002}};
  for (const double roughness : {0.15, 0.3, 0.5, 0.75, 1.0})
    for (const auto& [cosine, tolerance] : tolerances) {
      const Glossy varnish{glm::dvec3(0.3), glm::dvec3(0.04), roughness};
      EXPECT_LT(largest_error(varnish, cosine), tolerance) << roughness << ' ' << cosine;
    }
}

// Narrower than a midpoint rule can see.
TEST(UnshadowedLight, OfASmoothMetalIsTheMirrorImageOfTheLight) {
  for (const double roughness : {0.001, 0.02, 0.05})
    for (const double cosine : {0.1, 0.3, 0.7, 1.0}) {
      const ShadingPoint<double> point =
          point_of({glm::dvec3(0), glm::dvec3(1), roughness}, cosine);
      const glm::dvec3 mirror(-std::sqrt(1 - cosine * cosine), cosine, 0);
      const Light light = unit_light(LightShape::kRectangle, 0.5, 0.15);
      EXPECT_NEAR(shade(light, aimed(2.0 * mirror), point).x, 1, 0.06);
      EXPECT_NEAR(shade(light, aimed(2.0 * mirror + glm::dvec3(0, 0, 0.5)), point).x, 0, 0.005);
    }
}

TEST(UnshadowedLight, OfADiffuseSurfaceIsLambertsIntegral) {
  for (const double cosine : {0.1, 0.7})
    for (const auto& [light, place] : rectangles(cosine)) {
      const Glossy chalk{{0.2, 0.5, 0.9}};
      const ShadingPoint<double> point = point_of(chalk, cosine);
      const glm::dvec3 truth = brute_force(light, place, chalk, point, 500);
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(shade(light, place, point)[c], truth[c], 2e-5);
    }
}

TEST(UnshadowedLight, OfDisksAndSpheresIsTheIntegralOfTheBrdf) {
  for (const LightShape shape : {LightShape::kDisk, LightShape::kSphere})
    for (const glm::dvec3& at :
         {glm::dvec3(-1.5, 1.2, 0.3), glm::dvec3(0.2, 0.9, 0.1), glm::dvec3(-1.5, 0.1, 0)}) {
      const Light light = unit_light(shape, 0.7);
      const Glossy chalk{glm::dvec3(0.8)}, metal{glm::dvec3(0), glm::dvec3(1), 0.5};
      const auto place = aimed(at);
      const double diffuse = brute_force(light, place, chalk, point_of(chalk, 0.6), 500).x;
      EXPECT_NEAR(shade(light, place, point_of(chalk, 0.6)).x, diffuse, 0.01 * diffuse + 1e-3);
      const double glossy = brute_force(light, place, metal, point_of(metal, 0.6), 500).x;
      EXPECT_NEAR(shade(light, place, point_of(metal, 0.6)).x, glossy, 0.03);
    }
}

TEST(UnshadowedLight, OfASphereAboveTheHorizonIsItsClosedForm) {
  const ShadingPoint<double> point = point_of({glm::dvec3(1)}, 0.5);
  for (const double distance : {0.51, 0.7, 2.0, 30.0}) {
    const glm::dvec3 at = distance * glm::normalize(glm::dvec3(0.2, 3, 0.1));
    const double truth = 0.25 / (distance * distance) * at.y / distance;
    if (at.y < 0.5) continue;
    EXPECT_NEAR(shade(unit_light(LightShape::kSphere, 0.5), aimed(at), point).x, truth,
                0.01 * truth);
  }
}

TEST(UnshadowedLight, OfAPointIsIntensityOverDistanceSquared) {
  Light light = unit_light(LightShape::kPoint, 0);
  light.radiance = {2, 4, 6};
  const glm::dvec3 to_light = glm::normalize(glm::dvec3(-1, 2, 0.5));
  const Glossy material{{0.3, 0.2, 0.1}, glm::dvec3(1), 0.4};
  const ShadingPoint<double> point = point_of(material, 0.7);
  const glm::dvec3 truth =
      light.radiance * brdf(material, point.normal, point.to_viewer, to_light) * to_light.y / 9.0;
  const glm::dvec3 mine = shade(light, aimed(3.0 * to_light), point);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(mine[c], truth[c], 2e-3 * truth[c]);
}

TEST(UnshadowedLight, OfASunIsItsIrradianceAtAnyAngularRadius) {
  const glm::dvec3 to_sun = glm::normalize(glm::dvec3(-1, 2, 0.5));
  const Glossy chalk{glm::dvec3(0.5)}, metal{glm::dvec3(0), glm::dvec3(1), 0.6};
  // A lobe of GGX is a transformed cosine to no better than 8 % at every single direction.
  for (const auto& [material, tolerance] : {std::pair{chalk, 0.002}, std::pair{metal, 0.08}}) {
    const ShadingPoint<double> point = point_of(material, 0.7);
    const double truth = brdf(material, point.normal, point.to_viewer, to_sun).x * to_sun.y;
    for (const double radius : {0.0, 5e-5, 2e-4, 0.0047, 0.05}) {
      const Light sun = unit_light(LightShape::kDirectional, radius);
      EXPECT_NEAR(shade(sun, aimed(to_sun), point).x, truth, tolerance * truth) << radius;
    }
  }
}

TEST(UnshadowedLight, ReturnsWhatAWhiteFurnaceReturns) {
  // A light that fills the hemisphere but for a narrow band.
  const Light sky = unit_light(LightShape::kRectangle, 2e5, 2e5);
  for (const double roughness : {0.0, 0.2, 0.5, 1.0})
    for (const double cosine : {0.05, 0.3, 0.9}) {
      const ShadingPoint<double> point =
          point_of({{0.5, 0.5, 0.5}, glm::dvec3(0.7), std::max(1e-9, roughness)}, cosine);
      EXPECT_NEAR(shade(sky, aimed({0, 1, 0}), point).x, 0.5 + point.specular.x, 1e-4)
          << roughness << ' ' << cosine;
    }
}

TEST(UnshadowedLight, TurnsAndMirrorsWithTheScene) {
  Random random(5);
  const Glossy material{{0.3, 0.2, 0.1}, glm::dvec3(0.6), 0.4};
  for (const auto& [light, place] : rectangles(0.4)) {
    const ShadingPoint<double> point = point_of(material, 0.4);
    const glm::dvec3 still = shade(light, place, point);
    const glm::dmat4 mirror = glm::scale(glm::dmat4(1), {1, 1, -1});
    for (const glm::dmat4& move :
         {random_rigid(random, 3, 50), random_rigid(random, 3, 50), mirror}) {
      ShadingPoint<double> moved = point;
      moved.position = move * glm::dvec4(point.position, 1);
      moved.normal = move * glm::dvec4(point.normal, 0);
      moved.to_viewer = move * glm::dvec4(point.to_viewer, 0);
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(shade(light, move * place, moved)[c], still[c], 1e-10);
    }
  }
}

TEST(UnshadowedLight, IsZeroBehindTheLightBelowTheHorizonAndInsideASphere) {
  const ShadingPoint<double> point = point_of({glm::dvec3(0.5), glm::dvec3(1), 0.3}, 0.6);
  const glm::dvec3 zero(0);
  for (const LightShape shape : {LightShape::kRectangle, LightShape::kDisk}) {
    EXPECT_NE(shade(unit_light(shape, 1, 1), aimed({0, 1, 0}), point), zero);
    EXPECT_EQ(shade(unit_light(shape, 1, 1), aimed({0, 1, 0}, {0, 2, 0}), point), zero);
  }
  for (const LightShape shape :
       {LightShape::kRectangle, LightShape::kDisk, LightShape::kSphere, LightShape::kPoint})
    EXPECT_EQ(shade(unit_light(shape, 0.5, 1), aimed({0, -2, 0.1}), point), zero);
  EXPECT_EQ(shade(unit_light(LightShape::kDirectional, 0.01), aimed({0, -1, 0.1}), point), zero);
  EXPECT_EQ(shade(unit_light(LightShape::kSphere, 2), aimed({0, 1, 0}), point), zero);
}

// Where light ends at exactly 0, rounding would decide on which side a surface in the plane of its
// light is, and so what a filter does with its visibility (core/history/unlit.h).
TEST(UnshadowedLight, ReachesNoSurfaceInItsOwnPlaneWhereverThatIs) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (const LightShape shape : {LightShape::kRectangle, LightShape::kDisk, LightShape::kPoint})
    for (int k = 0; k < 2000; ++k) {
      const glm::dvec3 n = glm::normalize(glm::dvec3(unit(random), unit(random), unit(random)));
      const glm::dvec3 along = glm::normalize(glm::cross(n, glm::dvec3(unit(random), 1, 0.3)));
      const glm::dvec3 centre(30 * unit(random), 30 * unit(random), 30 * unit(random));
      ShadingPoint<float> point;
      point.position = centre + (1.5 + std::abs(unit(random))) * along;
      point.normal = n;
      point.to_viewer = glm::normalize(n + 0.5 * along);
      point.albedo = point.specular = glm::vec3(0.5f);
      const Light light = unit_light(shape, 0.2, 0.4);
      const glm::vec3 found =
          unshadowed_light(place_light<float>(light, aimed(centre, centre + n)), point);
      EXPECT_EQ(found, glm::vec3(0.0f)) << k;
    }
}

// A sliver above the horizon is a difference of near equals, which floats may make 0.
TEST(UnshadowedLight, IsMoreThanZeroInFloatWhereASliverReaches) {
  const Light light = unit_light(LightShape::kRectangle, 0.4, 0.4);
  ShadingPoint<float> point;
  point.normal = {0, 1, 0};
  for (const glm::vec3 albedo : {glm::vec3(0.5f), glm::vec3(0)}) {
    point.albedo = albedo;
    point.specular = glm::vec3(0.5f);
    point.roughness = 0.05f;
    for (int k = 0; k < 400; ++k) {
      point.to_viewer = glm::normalize(glm::vec3(0.2f, 1, 0.01f * static_cast<float>(k)));
      const glm::dvec3 at(-2, -0.2 + 4e-4 + 1e-5 * k, 0.3);
      const glm::vec3 found =
          unshadowed_light(place_light<float>(light, aimed(at, {0, at.y, 0.3})), point);
      EXPECT_GT(found.x, 0.0f) << k;
    }
  }
}

TEST(UnshadowedLight, InFloatAgreesWithDouble) {
  for (const double roughness : {0.05, 0.3, 0.9})
    for (const double cosine : {0.1, 0.8})
      for (const auto& [light, place] : rectangles(cosine)) {
        const ShadingPoint<double> point =
            point_of({glm::dvec3(0.5), glm::dvec3(1), roughness}, cosine);
        const auto mine =
            unshadowed_light(place_light<float>(light, place), point_in<float>(point));
        EXPECT_NEAR(double(mine.x), shade(light, place, point).x, 1e-5)
            << roughness << ' ' << cosine;
      }
}

TEST(UnshadowedLight, IsFiniteAtEveryExtreme) {
  for (const LightShape shape : {LightShape::kRectangle, LightShape::kDisk, LightShape::kSphere,
                                 LightShape::kPoint, LightShape::kDirectional})
    for (const double size : {0.0, 1e-12, 1.0, 1e12})
      for (const glm::dvec3& at : {glm::dvec3(0), glm::dvec3(0, 1e-7, 0), glm::dvec3(0.5, 0, 0),
                                   glm::dvec3(0, 1, 0), glm::dvec3(1e12, 1e12, 0)})
        for (const double roughness : {0.0, 1.0})
          for (const double cosine : {0.0, 1e-6, 1.0}) {
            Light light = unit_light(shape, size, size);
            light.radiance = glm::dvec3(1e15);
            ShadingPoint<float> point = point_in<float>(point_seen_under(cosine));
            point.albedo = point.specular = glm::vec3(1);
            point.roughness = static_cast<float>(roughness);
            const glm::dmat4 place = glm::translate(glm::dmat4(1), at);
            for (const glm::dmat4& turn :
                 {glm::dmat4(1), glm::rotate(glm::dmat4(1), -std::numbers::pi / 2, {1, 0, 0})}) {
              const glm::vec3 colour =
                  unshadowed_light(place_light<float>(light, place * turn), point);
              EXPECT_TRUE(std::isfinite(colour.x) && colour.x >= 0.0f)
                  << light_shape_name(shape) << ' ' << size << ' ' << at.x << ' ' << at.y << ' '
                  << roughness << ' ' << cosine << ": " << colour.x;
              if (size == 0.0 && shape < LightShape::kPoint) {
                EXPECT_EQ(colour.x, 0.0f);
              }
            }
          }
}

}  // namespace
}  // namespace holdfast
