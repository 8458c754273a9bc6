#include "core/spatial/half_grid.h"

#include <utility>

#include <gtest/gtest.h>

#include "core/frame/scene_motion.h"
#include "tests/core/small_world.h"

namespace holdfast {
namespace {

constexpr std::pair<int, int> kSizes[] = {{1, 1}, {1, 7}, {5, 3}, {6, 4}, {33, 17}};

/// Guides of half the size of `full`, with its view.
Guides halved(const Guides& full, const HalfGrid& grid) {
  Guides half(half_size(full.view.width), half_size(full.view.height));
  half.view = full.view.halved();
  half.rays = half.view.rays.cast<float>();
  halve_guides(full, grid, half);
  return half;
}

HalfGrid grid_of(const Guides& full) {
  HalfGrid grid(full.view.width, full.view.height);
  choose_representatives(full, grid);
  return grid;
}

/// A plane through (0, 0, -5) that leans to all sides.
Guides leaning_plane(const Camera& camera, int width, int height) {
  Guides guides = test::empty_guides(camera, width, height);
  const glm::vec3 normal = glm::normalize(glm::vec3(0.4f, -0.3f, 1.0f));
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const float px = static_cast<float>(x) + 0.5f, py = static_cast<float>(y) + 0.5f;
      const float at_0 = glm::dot(normal, guides.rays.position(px, py, 0.0f));
      const float at_1 = glm::dot(normal, guides.rays.position(px, py, 1.0f));
      test::set_pixel(guides, x, y, (-5.0f * normal.z - at_0) / (at_1 - at_0), normal, 1);
    }
  return guides;
}

TEST(HalfGrid, SharesOfAQuadSumToOneAtEverySize) {
  test::Random random(1);
  for (const auto& [width, height] : kSizes) {
    Guides full = test::wall(test::perspective_camera(width, height), width, height);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)
        if (random.uniform() < 0.3) test::set_pixel(full, x, y, 0.0f, glm::vec3(0));
    const HalfGrid grid = grid_of(full);
    for (int y = 0; y < half_size(height); ++y)
      for (int x = 0; x < half_size(width); ++x) {
        float sum = 0;
        for (int k = 0; k < HalfGrid::kQuad; ++k) {
          const float share = grid.share[k].at(x, y);
          const bool inside = 2 * x + k % 2 < width && 2 * y + k / 2 < height;
          EXPECT_TRUE(inside || share == 0.0f) << "a share beyond the edge";
          sum += share;
        }
        EXPECT_NEAR(sum, 1.0f, 1e-6f);
      }
  }
}

TEST(HalfGrid, AQuadStandsForTheSurfaceThatMostOfItShows) {
  Guides full = test::wall(test::perspective_camera(2, 2), 2, 2);
  test::set_pixel(full, 0, 0, 2.0f, {0, 0, 1}, 7);
  HalfGrid grid = grid_of(full);
  EXPECT_NE(grid.representative[0].at(0, 0), 0u);
  EXPECT_EQ(grid.share[0].at(0, 0), 0.0f);
  EXPECT_NEAR(grid.share[3].at(0, 0), 1.0f / 3, 1e-6f);
  test::set_pixel(full, 1, 0, 2.0f, {0, 0, 1}, 7);
  grid = grid_of(full);
  EXPECT_EQ(grid.representative[0].at(0, 0), 0u) << "of two and two, the nearer";
  EXPECT_EQ(grid.share[0].at(0, 0), 0.5f);
  EXPECT_EQ(grid.share[2].at(0, 0), 0.0f);
}

TEST(HalfGrid, SurfacesDifferByIdByNormalAndByDepth) {
  const auto shares = [](float depth, glm::vec3 normal, std::uint32_t id) {
    Guides full = test::wall(test::perspective_camera(2, 2), 2, 2);
    test::set_pixel(full, 1, 1, depth, normal, id);
    return grid_of(full).share[3].at(0, 0) > 0.0f;
  };
  EXPECT_TRUE(shares(5.0f, {0, 0, 1}, 1));
  EXPECT_FALSE(shares(5.0f, {0, 0, 1}, 2));
  EXPECT_FALSE(shares(5.0f, {1, 0, 0}, 1));
  EXPECT_FALSE(shares(50.0f, {0, 0, 1}, 1));
  EXPECT_FALSE(shares(0.0f, {0, 0, 0}, 0));
}

// The middle of a quad lies on the plane of its pixels, whichever represents it.
TEST(HalfGrid, PointsOfAPlaneStayOnIt) {
  for (const auto camera : {test::perspective_camera, test::orthographic_camera}) {
    const Guides full = leaning_plane(camera(16, 12, {}, {0, 0, -1}), 16, 12);
    const Guides half = halved(full, grid_of(full));
    const glm::vec3 n = full.normal_at(0, 0);
    for (int y = 0; y < 6; ++y)
      for (int x = 0; x < 8; ++x) {
        EXPECT_NEAR(glm::dot(n, half.position_at(x, y) - full.position_at(0, 0)), 0.0f, 1e-5f);
        const glm::vec3 middle =
            0.5f * (full.position_at(2 * x, 2 * y) + full.position_at(2 * x + 1, 2 * y + 1));
        EXPECT_LT(glm::length(half.position_at(x, y) - middle), 0.02f * glm::length(middle));
      }
  }
}

TEST(HalfGrid, AHalvedViewProjectsToHalfThePosition) {
  for (const auto& [width, height] : kSizes) {
    const ViewGeometry full(test::perspective_camera(width, height, {1, 2, 3}), width, height);
    const ViewGeometry half = full.halved();
    EXPECT_EQ(half.width, (width + 1) / 2);
    EXPECT_EQ(half.height, (height + 1) / 2);
    const glm::dvec3 point = full.rays.position(0.4 * width, 0.7 * height, 4.0);
    const auto at = project(half.pixel_from_relative, point);
    EXPECT_NEAR(at.x, 0.2 * width, 1e-9);
    EXPECT_NEAR(at.y, 0.35 * height, 1e-9);
    EXPECT_NEAR(at.depth, 4.0, 1e-9);
    const glm::dvec3 back = half.rays.position(at.x, at.y, 4.0);
    EXPECT_LT(glm::distance(back, point), 1e-9);
  }
}

TEST(HalfGrid, AHalvedSceneMovesHalfAsManyPixels) {
  Frame frame;
  SceneMotion full, half;
  for (int index = 0; index < 2; ++index) {
    frame.index = index;
    frame.camera = test::perspective_camera(32, 18, {0.1 * index, 0, 0});
    frame.objects[3] = glm::translate(glm::dmat4(1), {0, 0.2 * index, 0});
    full.advance(frame, 32, 18, {});
  }
  half.follow_halved(full);
  const glm::vec4 point(0.3f, 0.2f, -4.0f, 1.0f);
  for (int slot = 0; slot < 2; ++slot) {
    const glm::mat4 matrices[][2] = {{full.object(slot).prev_pixel, half.object(slot).prev_pixel},
                                     {full.object(slot).next_pixel, half.object(slot).next_pixel}};
    for (const auto& pair : matrices) {
      const auto a = project(pair[0], point), b = project(pair[1], point);
      EXPECT_NEAR(0.5f * a.x, b.x, 1e-5f);
      EXPECT_NEAR(0.5f * a.y, b.y, 1e-5f);
      EXPECT_EQ(a.depth, b.depth);
    }
  }
}

TEST(HalfGrid, NoSampleOfAQuadsSurfaceIsWasted) {
  const int width = 5, height = 3;
  Guides full = test::wall(test::perspective_camera(width, height), width, height);
  test::set_pixel(full, 1, 0, 2.0f, {0, 0, 1}, 7);
  Channels<float> signal(width, height, 1), half(3, 2, 1);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) signal[0].at(x, y) = static_cast<float>(10 * y + x);
  signal[0].at(1, 0) = 1e9f;
  test::poison_padding(signal[0]);
  halve_signal(signal, 1, grid_of(full), half);
  EXPECT_NEAR(half[0].at(0, 0), (0.0f + 10.0f + 11.0f) / 3, 1e-5f);
  EXPECT_NEAR(half[0].at(1, 0), (2.0f + 3.0f + 12.0f + 13.0f) / 4, 1e-5f);
  EXPECT_NEAR(half[0].at(2, 0), (4.0f + 14.0f) / 2, 1e-5f);
  EXPECT_NEAR(half[0].at(0, 1), 20.5f, 1e-5f);
  EXPECT_EQ(half[0].at(2, 1), 24.0f);
}

TEST(HalfGrid, PlanesAndGuidesAreThoseOfTheRepresentative) {
  Guides full = test::wall(test::perspective_camera(4, 2), 4, 2);
  for (const int x : {0, 2}) test::set_pixel(full, x, 1, 2.0f, {0, 0, 1}, 7);
  test::set_pixel(full, 2, 0, 2.0f, {0, 0, 1}, 7);
  test::set_pixel(full, 3, 0, 2.0f, {0, 0, 1}, 7);
  full.motion = Channels<float>(4, 2, 2);
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 4; ++x) full.motion[0].at(x, y) = static_cast<float>(10 * y + x);
  const HalfGrid grid = grid_of(full);
  Guides half(2, 1);
  half.motion = Channels<float>(2, 1, 2);
  half.view = full.view.halved();
  half.rays = half.view.rays.cast<float>();
  halve_guides(full, grid, half);
  EXPECT_EQ(half.id[0].at(0, 0), 1u);
  EXPECT_EQ(half.id[0].at(1, 0), 7u);
  EXPECT_EQ(half.motion[0].at(0, 0), 0.0f);
  EXPECT_EQ(half.motion[0].at(1, 0), 1.0f) << "vectors in pixels of twice the size";
  Plane ids({PlaneKind::kGlossyHitId, {}}, 4, 2), half_ids({PlaneKind::kGlossyHitId, {}}, 2, 1);
  for (int x = 0; x < 4; ++x) ids.ids().at(x, 0) = static_cast<std::uint32_t>(x + 5);
  halve_plane(ids, grid, half_ids);
  EXPECT_EQ(half_ids.ids().at(0, 0), 5u);
  EXPECT_EQ(half_ids.ids().at(1, 0), 7u);
}

}  // namespace
}  // namespace holdfast
