// What references of glossy and indirect light stand on: even points, and a cache that does not
// shift their mean.

#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "client/scenes/light_target.h"
#include "client/scenes/path_points.h"
#include "client/scenes/radiance_cache.h"
#include "tests/scenes/small_scenes.h"

namespace holdfast::scenes {
namespace {

/// True if each box of every grid of n = 2^m equal boxes holds one of the n points.
template <class Point>
bool is_even(int m, const Point& point) {
  for (int a = 0; a <= m; ++a) {
    std::set<int> boxes;
    for (std::uint32_t i = 0; i < 1u << m; ++i) {
      const glm::dvec2 p = point(i);
      boxes.insert(static_cast<int>(p.x * (1 << a)) * (1 << (m - a)) +
                   static_cast<int>(p.y * (1 << (m - a))));
    }
    if (boxes.size() != std::size_t{1} << m) return false;
  }
  return true;
}

TEST(SobolPoints, FillEveryGridEvenly) {
  for (std::uint64_t seed = 0; seed < 5; ++seed)
    for (const int m : {0, 1, 4, 9})
      for (const std::uint32_t first : {0u, 512u, 7u * 512u})
        EXPECT_TRUE(is_even(
            m, [&](std::uint32_t i) { return sobol_point(first + i, mix_bits(seed + 1)); }));
}

TEST(SobolPoints, AreUniformOverScramblings) {
  glm::dvec2 sum(0.0), squares(0.0);
  constexpr int kCount = 20000;
  for (std::uint64_t seed = 1; seed <= kCount; ++seed) {
    const glm::dvec2 p = sobol_point(5, mix_bits(seed));
    sum += p;
    squares += p * p;
  }
  for (int c = 0; c < 2; ++c) {
    EXPECT_NEAR(sum[c] / kCount, 0.5, 0.01);
    EXPECT_NEAR(squares[c] / kCount, 1.0 / 3.0, 0.01);
  }
}

TEST(PathPoints, AreEvenInEachPairAndApartFromEachOther) {
  constexpr std::uint32_t kPaths = 1024;
  for (const int pair : {0, 3})
    EXPECT_TRUE(is_even(10, [&](std::uint32_t i) {
      PathPoints points(99, i);
      for (int k = 0; k < pair; ++k) points.next2();
      return points.next2();
    }));
  double product = 0.0;
  for (std::uint32_t i = 0; i < kPaths; ++i) {
    PathPoints points(99, i);
    const double u = points.next2().x, v = points.next2().x;
    product += 12.0 * (u - 0.5) * (v - 0.5);
  }
  EXPECT_NEAR(product / kPaths, 0.0, 0.15) << "their correlation";
}

CachePlace place(float x, float y, const glm::vec3& normal, std::uint32_t object = 2) {
  return {object, {x, y, 0.0f}, normal};
}

TEST(RadianceCache, GivesTheMeanOfTheCellAskedFor) {
  RadianceCache cache(0.8);  // the finest cells: 0.1
  const glm::vec3 up(0.0f, 0.0f, 2.0f);
  for (int i = 0; i < 8; ++i) {
    cache.add(place(0.05f, 0.05f, up), glm::vec3(1.0f));
    cache.add(place(0.15f, 0.05f, up), glm::vec3(3.0f));
  }
  cache.finish();
  EXPECT_EQ(cache.find(place(0.02f, 0.09f, up), 0.1f)->x, 1.0f);
  EXPECT_EQ(cache.find(place(0.12f, 0.09f, up), 0.15f)->y, 3.0f);
  EXPECT_FLOAT_EQ(cache.find(place(0.12f, 0.09f, up), 0.2f)->z, 2.0f);
  EXPECT_FLOAT_EQ(cache.find(place(0.7f, 0.7f, up), 5.0f)->z, 2.0f);
  EXPECT_FLOAT_EQ(cache.find(place(0.3f, 0.3f, up), 0.1f)->x, 2.0f)
      << "nothing there: the nearest level that knows";
  EXPECT_EQ(cache.find(place(0.9f, 0.1f, up), 0.1f), nullptr);
}

TEST(RadianceCache, KeepsObjectsAndSidesApart) {
  RadianceCache cache(0.4);
  const glm::vec3 up(0.1f, 0.2f, 1.0f);
  for (int i = 0; i < 4; ++i) cache.add(place(0.0f, 0.0f, up), glm::vec3(1.0f));
  cache.finish();
  EXPECT_NE(cache.find(place(0.01f, 0.01f, up), 0.1f), nullptr);
  EXPECT_EQ(cache.find(place(0.01f, 0.01f, -up), 0.4f), nullptr);
  EXPECT_EQ(cache.find(place(0.01f, 0.01f, up, 3), 0.4f), nullptr);
}

TEST(RadianceCache, GrowsAndForgetsNothing) {
  RadianceCache cache(0.8);
  const glm::vec3 up(0.0f, 0.0f, 1.0f);
  const auto at = [&](int i) {
    return place(0.1f * static_cast<float>(i % 100) + 0.05f,
                 0.1f * static_cast<float>(i / 100) + 0.05f, up);
  };
  for (int repeat = 0; repeat < 4; ++repeat)
    for (int i = 0; i < 5000; ++i) cache.add(at(i), glm::vec3(static_cast<float>(i)));
  cache.finish();
  for (int i = 0; i < 5000; ++i) EXPECT_EQ(cache.find(at(i), 0.1f)->x, static_cast<float>(i)) << i;
}

/// Images of two seeds of paths and of references. Where neither is shifted against the other, the
/// product of the differences of independent pairs has mean 0; else it is the shift squared.
void expect_no_shift(const Scene& scene, PlaneKind kind) {
  constexpr int kWidth = 32, kHeight = 18;
  const StillView still(scene, kWidth, kHeight);
  std::vector<PlaneSet> paths, references;
  for (const std::uint64_t seed : {1ull, 2ull}) {
    View view = still.view;
    view.seed = seed;
    paths.push_back(render_noisy(view, 1024));
    references.push_back(render_reference(view, 1024));
  }
  double product = 0.0, mean = 0.0, truth = 0.0;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      for (int c = 0; c < 3; ++c) {
        double difference[2];
        for (std::size_t k = 0; k < 2; ++k) {
          const double a = colour_at(paths[k], kind, x, y)[c];
          const double b = colour_at(references[k], kind, x, y)[c];
          difference[k] = a / (1.0 + a) - b / (1.0 + b);
          mean += 0.5 * difference[k];
          truth += 0.5 * a / (1.0 + a);
        }
        product += difference[0] * difference[1];
      }
  constexpr int kCount = 3 * kWidth * kHeight;
  EXPECT_LT(std::abs(mean), 0.005 * truth);
  EXPECT_LT(product / kCount, 0.0015 * 0.0015);
}

TEST(Reference, OfIndirectLightHasTheMeanOfPaths) {
  expect_no_shift(occluder_scene(), PlaneKind::kIndirect);
  expect_no_shift(static_scene(), PlaneKind::kIndirect);
}

TEST(Reference, OfGlossyLightHasTheMeanOfPaths) {
  expect_no_shift(static_scene(), PlaneKind::kGlossy);
}

TEST(Reference, OfVisibilityIsSettledWhereALightBarelyClearsTheHorizon) {
  // A wall whose plane leaves a ten-thousandth of the light on its side, shaded by nothing.
  Scene scene = floor_and_box(rectangle_light(), {0.0, 3.0, 0.0});
  scene.lights[0].light.width = scene.lights[0].light.height = 1.0;
  const LightState light = lights_at(scene, 0.0).front();
  Surface surface;
  surface.albedo = glm::dvec3(0.5);
  surface.normal = {1.0, 0.0, 0.0};
  surface.position = {0.4999, 0.0, 0.0};
  EXPECT_FALSE(LightTarget(light, surface).reaches());
  EXPECT_EQ(LightTarget(light, surface).unshadowed(), glm::dvec3(0.0));
  surface.position.x = 0.45;
  EXPECT_TRUE(LightTarget(light, surface).reaches());
}

}  // namespace
}  // namespace holdfast::scenes
