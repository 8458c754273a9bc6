#include "core/motion/follow_block.h"

#include <vector>

#include <gtest/gtest.h>

#include "core/motion/shadow_motion.h"
#include "core/motion/surface_motion.h"
#include "tests/core/isa_guard.h"
#include "tests/core/small_world.h"

namespace holdfast {
namespace {

constexpr int kSizes[] = {1, 7, 16, 33, kFollowBlock};

/// A motion in double, and rounded as the core applies it.
struct Motion {
  ObjectMotion<double> exact;
  ObjectMotion<float> rounded;

  Motion(test::Random& random, const ViewGeometry& previous) {
    exact.carry = test::random_rigid(random, 0.2, 0.3);
    exact.rotate = glm::dmat3(exact.carry);
    exact.prev_pixel = previous.pixel_from_relative * exact.carry;
    rounded.carry = glm::mat4(exact.carry);
    rounded.rotate = glm::mat3(exact.rotate);
    rounded.prev_pixel = glm::mat4(exact.prev_pixel);
  }
};

/// Random surfaces before a camera, one row of them looked at.
struct Row {
  Camera camera;
  Guides guides;
  Row(Camera (*make)(int, int, glm::dvec3, glm::dvec3), int width, test::Random& random)
      : camera(make(width, 3, {1, 2, 3}, {0.2, -0.1, -1})),
        guides(test::empty_guides(camera, width, 3)) {
    for (int x = 0; x < width; ++x)
      test::set_pixel(guides, x, 1, random.real(1, 9),
                      glm::normalize(glm::vec3(random.in_box(1)) + glm::vec3(0, 0, 2)));
  }
  glm::dvec3 point(int x) const {
    return guides.view.rays.position(x + 0.5, 1.5, double(guides.depth().at(x, 1)));
  }
};

// Float rounding: 1e-6 of positions of up to 10 m; of pixels, that over the depth times the focal
// length, at most 64 px wide images and few magnifications near the camera's plane.
constexpr double kMetres = 2e-5, kRelativePixels = 2e-5;

void expect_near(const FollowedBlock& got, int i, const PixelPoint<double>& want) {
  ASSERT_EQ(got.found[i] != 0.0f, want.in_front) << i;
  const double size = 64 + std::abs(want.x) + std::abs(want.y);
  ASSERT_NEAR(got.x[i], want.in_front ? want.x : 0, size * kRelativePixels / 0.05) << i;
  ASSERT_NEAR(got.y[i], want.in_front ? want.y : 0, size * kRelativePixels / 0.05) << i;
}

TEST(FollowBlock, SurfacesAgreeWithTheOracle) {
  const test::IsaGuard guard;
  test::Random random(51);
  for (const auto make : {test::perspective_camera, test::orthographic_camera})
    for (const int size : kSizes) {
      const Row row(make, size, random);
      const Motion motion(random, row.guides.view);
      for (const Isa isa : available_isas()) {
        select_isa(isa);
        FollowedBlock got;
        for (float& found : got.found) found = 7.0f;
        follow_surface({BlockPixels(row.guides, 0, 1, size), motion.rounded, got});
        for (int i = 0; i < size; ++i) {
          const glm::dvec3 point = row.point(i);
          const auto want = surface_previous_pixel(motion.exact, point);
          if (std::abs(want.depth) < 0.05) continue;  // on the camera's plane
          expect_near(got, i, want);
          const glm::dvec3 carried(motion.exact.carry * glm::dvec4(point, 1));
          const glm::dvec3 normal =
              glm::normalize(motion.exact.rotate * glm::dvec3(row.guides.normal_at(i, 1)));
          for (int axis = 0; axis < 3; ++axis) {
            ASSERT_NEAR(got.point[axis][i], carried[axis], kMetres) << isa_name(isa);
            ASSERT_NEAR(got.normal[axis][i], normal[axis], 1e-6) << isa_name(isa);
          }
        }
        for (int i = size; i < kFollowBlock; ++i)
          ASSERT_EQ(got.found[i], 7.0f) << "not of the block";
      }
    }
}

TEST(FollowBlock, ShadowsAgreeWithTheOracle) {
  const test::IsaGuard guard;
  test::Random random(52);
  int followed = 0;
  for (const float w : {1.0f, 0.0f})
    for (const int size : kSizes) {
      const Row row(test::perspective_camera, size, random);
      const Motion surface(random, row.guides.view), occluder(random, row.guides.view);
      const glm::mat4 previous_pixel(row.guides.view.pixel_from_relative);
      const glm::mat3 half_axes{{0.3f, 0.1f, 0}, {-0.1f, 0.3f, 0.2f}, {0, 0, 0}};
      std::vector<float> ratio, light[3], before[3];
      for (int i = 0; i < size; ++i) {
        ratio.push_back(random.real(0.1f, 0.9f) * (w > 0 ? 1.0f : 3.0f));
        for (int axis = 0; axis < 3; ++axis) {
          light[axis].push_back(random.real(-1, 1) + (axis == 2 ? 3.0f : 0.0f));
          before[axis].push_back(light[axis].back() + 0.1f);
        }
      }
      for (const Isa isa : available_isas()) {
        select_isa(isa);
        FollowedBlock got;
        follow_shadow({BlockPixels(row.guides, 0, 1, size),
                       surface.rounded,
                       occluder.rounded,
                       previous_pixel,
                       ratio.data(),
                       {light[0].data(), light[1].data(), light[2].data()},
                       {before[0].data(), before[1].data(), before[2].data()},
                       w,
                       half_axes,
                       got});
        for (int i = 0; i < size; ++i) {
          const auto k = static_cast<std::size_t>(i);
          const auto at = [k](const std::vector<float>* v) {
            return glm::dvec3(v[0][k], v[1][k], v[2][k]);
          };
          const glm::dvec3 point = row.point(i);
          const glm::dvec3 blocker = point + double(ratio[k]) * (at(light) - double(w) * point);
          const ShadowSample<double> sample{
              glm::dvec3(surface.exact.carry * glm::dvec4(point, 1)),
              glm::normalize(surface.exact.rotate * glm::dvec3(row.guides.normal_at(i, 1))),
              glm::dvec3(occluder.exact.carry * glm::dvec4(blocker, 1)),
              glm::dvec4(at(before), double(w))};
          const double sweep =
              shadow_sweep(sample, double(ratio[k]), glm::mat<3, 3, double>(half_axes));
          ASSERT_NEAR(got.sweep[i], sweep, 1e-4 * (1 + sweep)) << isa_name(isa);
          glm::dvec3 hit{0};
          PixelPoint<double> want{0, 0, 0, false};
          if (shadow_previous_point(sample, hit))
            want = project(row.guides.view.pixel_from_relative, hit);
          const glm::dvec3 towards = sample.light.w * sample.blocker - glm::dvec3(sample.light);
          const double descent = glm::dot(towards, sample.normal) / glm::length(towards);
          if (std::abs(descent) < 0.05 || std::abs(want.depth) < 0.2 ||
              std::abs(glm::dot(sample.surface - sample.blocker, sample.normal)) < 1e-3)
            continue;  // grazing, on the camera's plane or in the receiver's: ill-conditioned
          followed += want.in_front;
          expect_near(got, i, want);
        }
      }
    }
  EXPECT_GT(followed, 100);
}

}  // namespace
}  // namespace holdfast
