#include "core/motion/reflect_block.h"

#include <gtest/gtest.h>

#include "core/kernels/random.h"
#include "core/motion/glossy_motion.h"
#include "core/motion/shadow_falloff.h"
#include "core/motion/shadow_motion.h"
#include "tests/core/isa_guard.h"
#include "tests/core/small_world.h"

namespace holdfast {
namespace {

using test::Random;
constexpr int kSize = kFollowBlock;

/// One row of random surfaces that reflect random hits, two of them the sky, two without sample.
struct Reflections {
  Guides guides;
  float direction[3][kSize], hit_m[kSize];

  explicit Reflections(Random& random)
      : guides(test::empty_guides(test::perspective_camera(kSize, 3, {1, 2, 3}, {0.2, -0.1, -1}),
                                  kSize, 3)) {
    for (int x = 0; x < kSize; ++x) {
      const glm::vec3 normal = glm::normalize(glm::vec3(random.in_box(1)) + glm::vec3(0, 0, 2));
      test::set_pixel(guides, x, 1, random.real(2, 9), normal);
      const glm::vec3 towards = glm::normalize(glm::vec3(random.in_box(1)) + normal);
      for (int axis = 0; axis < 3; ++axis) direction[axis][x] = towards[axis];
      hit_m[x] = random.real(0, 5);
    }
    hit_m[4] = hit_m[9] = test::kInf;
    hit_m[6] = -1.0f;
    for (int axis = 0; axis < 3; ++axis) direction[axis][7] = 0.0f;
  }
  bool sampled(int x) const { return x != 6 && x != 7; }
  glm::dvec3 point(int x) const {
    return guides.view.rays.position(x + 0.5, 1.5, double(guides.depth().at(x, 1)));
  }
  glm::dvec4 hit(int x) const {
    const glm::dvec3 d(direction[0][x], direction[1][x], direction[2][x]);
    return std::isfinite(hit_m[x]) ? glm::dvec4(point(x) + double(hit_m[x]) * glm::normalize(d), 1)
                                   : glm::dvec4(glm::normalize(d), 0);
  }
};

ObjectMotion<float> moved_by(const glm::dmat4& carry) {
  ObjectMotion<float> motion;
  motion.carry = glm::mat4(carry);
  motion.rotate = glm::mat3(carry);
  return motion;
}

// Float rounding, magnified where an image comes close to the camera's plane.
void expect_place(float x, float y, const PixelPoint<double>& want, Isa isa, int i) {
  const double size = 64 + std::abs(want.x) + std::abs(want.y);
  ASSERT_NEAR(double(x), want.x, 1e-3 * size) << isa_name(isa) << ", lane " << i;
  ASSERT_NEAR(double(y), want.y, 1e-3 * size) << isa_name(isa) << ", lane " << i;
}

TEST(ReflectBlock, ImagesAgreeWithTheOracle) {
  const test::IsaGuard guard;
  Random random(71);
  const Reflections row(random);
  const glm::dmat4 surface = test::random_rigid(random, 0.1, 0.2);
  const glm::dmat4 hit = test::random_rigid(random, 0.1, 0.2);
  const glm::dmat4& pixel = row.guides.view.pixel_from_relative;
  const glm::mat4 rounded(pixel);
  for (const Isa isa : available_isas()) {
    select_isa(isa);
    FollowedBlock got;
    float now_x[kSize], now_y[kSize];
    follow_reflection({BlockPixels(row.guides, 0, 1, kSize),
                       moved_by(surface),
                       moved_by(hit),
                       rounded,
                       rounded,
                       {row.direction[0], row.direction[1], row.direction[2]},
                       row.hit_m,
                       got,
                       now_x,
                       now_y});
    int compared = 0;
    for (int i = 0; i < kSize; ++i) {
      const glm::dvec3 point = row.point(i), normal(row.guides.normal_at(i, 1));
      const glm::dvec3 then(surface * glm::dvec4(point, 1));
      const glm::dvec4 hit_then = row.hit(i).w > 0 ? hit * row.hit(i) : row.hit(i);
      const auto image = project(pixel, virtual_image(row.hit(i), point, normal));
      const auto image_then =
          project(pixel, virtual_image(hit_then, then, glm::dmat3(surface) * normal));
      if (std::min(std::abs(image.depth), std::abs(image_then.depth)) < 0.1) continue;
      const bool found = row.sampled(i) && image.in_front && image_then.in_front;
      ASSERT_EQ(got.found[i] > 0.0f, found) << isa_name(isa) << ", lane " << i;
      for (int axis = 0; axis < 3; ++axis)
        ASSERT_NEAR(double(got.point[axis][i]), then[axis], 2e-5);
      if (!found) continue;
      expect_place(got.x[i], got.y[i], image_then, isa, i);
      expect_place(now_x[i], now_y[i], image, isa, i);
      ++compared;
    }
    EXPECT_GT(compared, kSize / 2);
  }
}

TEST(ReflectBlock, PairsAreThoseOfTheirPixelsOnEveryInstructionSet) {
  const test::IsaGuard guard;
  const std::uint64_t key = mix_bits(5), first = (std::uint64_t{7} << 32) | 1000;
  for (const Isa isa : available_isas()) {
    select_isa(isa);
    float u[kSize], v[kSize];
    draw_pairs({key, first, kSize, u, v});
    for (int i = 0; i < kSize; ++i) {
      const UniformPair want = uniform_pair(key ^ mix_bits(first + static_cast<std::uint64_t>(i)));
      ASSERT_EQ(u[i], want.u) << isa_name(isa) << ", lane " << i;
      ASSERT_EQ(v[i], want.v) << isa_name(isa) << ", lane " << i;
    }
  }
}

TEST(ReflectBlock, DrawsAgreeWithTheOracle) {
  const test::IsaGuard guard;
  Random random(73);
  const Reflections row(random);
  const glm::dmat4& pixel = row.guides.view.pixel_from_relative;
  const glm::mat4 rounded(pixel);
  FollowedBlock from{};
  float roughness[kSize], u[kSize], v[kSize];
  for (int i = 0; i < kSize; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      from.point[axis][i] = static_cast<float>(row.point(i)[axis]);
      from.normal[axis][i] = row.guides.normal_at(i, 1)[axis];
    }
    roughness[i] = random.real();
    u[i] = random.real(1e-6f, 1);
    v[i] = random.real(1e-6f, 1);
  }
  for (const Isa isa : available_isas()) {
    select_isa(isa);
    float x[kSize], y[kSize];
    spread_reflection({rounded, 300.0f, roughness, row.hit_m, u, v, from, kSize, x, y});
    for (int i = 0; i < kSize; ++i) {
      if (row.hit_m[i] < 0.0f) continue;
      const glm::dvec3 point = row.point(i), normal(row.guides.normal_at(i, 1));
      const double view_m = glm::length(point);
      const auto spread =
          glossy_spread(300.0, double(roughness[i]) * double(roughness[i]), view_m,
                        double(row.hit_m[i]), std::abs(glm::dot(point, normal)) / view_m);
      const glm::dvec2 along = incidence_axis(pixel, point, normal);
      const double radius = std::sqrt(-2 * std::log(double(u[i])));
      const double angle = 2 * std::numbers::pi * double(v[i]);
      const glm::dvec2 want =
          radius * (std::cos(angle) * spread.in_plane * along +
                    std::sin(angle) * spread.out_of_plane * glm::dvec2(-along.y, along.x));
      // The axis is the difference of two places 0.1 % of the distance apart.
      ASSERT_NEAR(double(x[i]), want.x, 0.02 * (1 + glm::length(want))) << isa_name(isa) << i;
      ASSERT_NEAR(double(y[i]), want.y, 0.02 * (1 + glm::length(want))) << isa_name(isa) << i;
    }
  }
}

TEST(ShadowFalloff, AgreesWithTheOracle) {
  const test::IsaGuard guard;
  Random random(79);
  Guides guides = test::wall(test::perspective_camera(kSize, 8), kSize, 8);
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < kSize; ++x) guides.depth_normal[0].at(x, y) = random.real(4.8f, 5.2f);
  test::set_pixel(guides, 20, 3, 0.0f, glm::vec3(0));
  FollowedBlock at{};
  for (int i = 0; i < kSize; ++i) {
    at.x[i] = i == 20 ? 20.5f : random.real(-1, kSize + 1);
    at.y[i] = i == 20 ? 3.5f : random.real(0.5f, 7.5f);
    at.found[i] = 1.0f;
    const glm::vec3 normal = glm::normalize(glm::vec3(random.in_box(0.3)) + glm::vec3(0, 0, 1));
    for (int axis = 0; axis < 3; ++axis) at.normal[axis][i] = normal[axis];
    at.point[2][i] = -5.0f;
  }
  const PixelRays<double>& rays = guides.view.rays;
  for (const Isa isa : available_isas()) {
    select_isa(isa);
    float trust[kSize];
    shadow_falloff({guides, at, kSize, trust});
    for (int i = 0; i < kSize; ++i) {
      const int x = static_cast<int>(std::floor(at.x[i])), y = static_cast<int>(at.y[i]);
      const bool seen = x >= 0 && x < kSize && guides.depth().at(x, y) > 0.0f;
      double want = 0;
      if (seen) {
        const glm::dvec3 normal(at.normal[0][i], at.normal[1][i], at.normal[2][i]);
        const glm::dvec3 start = rays.position(double(at.x[i]), double(at.y[i]), 0.0);
        const glm::dvec3 ray = rays.position(double(at.x[i]), double(at.y[i]), 1.0) - start;
        const double depth = glm::dot(glm::dvec3(0, 0, -5) - start, normal) / glm::dot(ray, normal);
        const glm::dvec3 there = rays.position(x + 0.5, y + 0.5, double(guides.depth().at(x, y)));
        want =
            planarity_falloff(start + depth * ray, there, normal, guides.view.pixel_angle * depth);
      }
      ASSERT_NEAR(double(trust[i]), want, 2e-4) << isa_name(isa) << ", lane " << i;
    }
  }
}

}  // namespace
}  // namespace holdfast
