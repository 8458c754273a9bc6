#include "core/spatial/upsample.h"

#include <cmath>
#include <limits>
#include <utility>

#include <gtest/gtest.h>

#include "tests/core/isa_guard.h"
#include "tests/core/small_world.h"

namespace holdfast {
namespace {

constexpr std::pair<int, int> kSizes[] = {{1, 1}, {1, 7}, {5, 3}, {16, 9}, {131, 34}};

/// Surfaces of both sizes, and a signal at half size.
struct World {
  Guides full, half;
  Channels<float> in, beyond, out;

  World(Guides guides, test::Random& random)
      : full(std::move(guides)),
        half(half_size(full.view.width), half_size(full.view.height)),
        in(half.depth_normal.width(), half.depth_normal.height(), 3),
        beyond(full.view.width, full.view.height, 3),
        out(full.view.width, full.view.height, 3) {
    HalfGrid grid(full.view.width, full.view.height);
    choose_representatives(full, grid);
    half.view = full.view.halved();
    half.rays = half.view.rays.cast<float>();
    halve_guides(full, grid, half);
    for (int c = 0; c < 3; ++c) {
      test::fill_random(in[c], random, 0, 1);
      test::fill(beyond[c], -1.0f);
      test::poison_padding(in[c]);
    }
    for (int c = 0; c < 4; ++c) {
      test::poison_padding(full.depth_normal[c]);
      test::poison_padding(half.depth_normal[c]);
    }
  }

  void run(int channels = 3) {
    Upsampling upsampling(full.view.width, full.view.height);
    upsampling.find(full, half);
    Upsampling::Signal signal;
    signal.channels = channels;
    for (int c = 0; c < channels; ++c) {
      signal.in[c] = in[c];
      signal.beyond[c] = beyond[c];
      signal.out[c] = out[c];
    }
    upsampling.run(signal);
  }
};

/// Walls of two depths and ids, leaning, with sky.
Guides random_surfaces(const Camera& camera, int width, int height, test::Random& random) {
  Guides guides = test::empty_guides(camera, width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const bool far = (x / 5 + y / 3) % 3 == 0;
      if (random.uniform() < 0.1) continue;
      const float tilt = (far ? 0.2f : -0.1f) + random.real(-0.02f, 0.02f);
      test::set_pixel(guides, x, y, (far ? 9.0f : 4.0f) + random.real(0, 0.02f),
                      glm::normalize(glm::vec3(tilt, 0.1f, 1.0f)), far ? 1 : 2);
    }
  return guides;
}

/// The documented formula in double, from positions in space.
class Oracle {
 public:
  explicit Oracle(const World& world) : w_(world) {}

  struct Mean {
    double value = 0, weight = 0;
  };
  Mean mean(int x, int y, int c) const {
    Mean m;
    for (int qy = 0; qy < w_.half.view.height; ++qy)
      for (int qx = 0; qx < w_.half.view.width; ++qx) {
        const double g = bilinear(x, qx) * bilinear(y, qy) * similarity(x, y, qx, qy);
        m.value += g * double{w_.in[c].at(qx, qy)};
        m.weight += g;
      }
    m.value /= m.weight;
    return m;
  }

 private:
  /// A tent two half pixels wide.
  static double bilinear(int x, int q) {
    return std::max(0.0, 1 - std::abs((x + 0.5) / 2 - q - 0.5));
  }
  double similarity(int x, int y, int qx, int qy) const {
    const double d = w_.full.depth().at(x, y), dq = w_.half.depth().at(qx, qy);
    if (!(dq > 0) || w_.full.id[0].at(x, y) != w_.half.id[0].at(qx, qy)) return 0;
    const glm::dvec3 n(w_.full.normal_at(x, y)), nq(w_.half.normal_at(qx, qy));
    const PixelRays<double>& rays = w_.full.view.rays;
    const glm::dvec3 p = rays.position(x + 0.5, y + 0.5, d);
    const glm::dvec3 q = rays.position(2 * qx + 1, 2 * qy + 1, dq);
    const double px = w_.full.view.pixel_angle * (rays.near_weight + rays.far_weight * d);
    return std::exp(-std::abs(glm::dot(n, q - p)) / (2 * px) -
                    128 * std::max(0.0, 1 - glm::dot(n, nq)));
  }
  const World& w_;
};

TEST(Upsample, AgreesWithTheOracleAtEverySizeOnEveryInstructionSet) {
  const test::IsaGuard guard;
  test::Random random(31);
  int compared = 0;
  for (const auto camera : {test::perspective_camera, test::orthographic_camera})
    for (const auto& [width, height] : kSizes) {
      World world(
          random_surfaces(camera(width, height, {1, 2, 3}, {0, 0, -1}), width, height, random),
          random);
      const Oracle oracle(world);
      for (const Isa isa : available_isas()) {
        select_isa(isa);
        world.run();
        for (int y = 0; y < height; ++y)
          for (int x = 0; x < width; ++x) {
            if (!(world.full.depth().at(x, y) > 0.0f)) continue;
            const Oracle::Mean m = oracle.mean(x, y, 1);
            if (m.weight < 2 * double{Upsampling::kLeastWeight}) continue;
            ++compared;
            // Rounding of the exponent, 1e-4 at most, shifts a mean of values in 0..1 by less.
            ASSERT_NEAR(double{world.out[1].at(x, y)}, m.value, 1e-4)
                << isa_name(isa) << ' ' << width << 'x' << height << " at " << x << ", " << y;
          }
      }
    }
  EXPECT_GT(compared, 10000);
}

TEST(Upsample, ConstantImageIsAFixedPointAtEverySize) {
  test::Random random(32);
  for (const int channels : {1, 3})
    for (const auto& [width, height] : kSizes) {
      World world(random_surfaces(test::perspective_camera(width, height), width, height, random),
                  random);
      for (int c = 0; c < 3; ++c) test::fill(world.in[c], 0.7f);
      // What half pixels without surface hold must not be seen.
      for (int y = 0; y < world.half.view.height; ++y)
        for (int x = 0; x < world.half.view.width; ++x)
          if (!(world.half.depth().at(x, y) > 0.0f)) world.in[0].at(x, y) = 1e9f;
      world.run(channels);
      for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
          ASSERT_NEAR(world.out[0].at(x, y), world.full.depth().at(x, y) > 0.0f ? 0.7f : -1.0f,
                      1e-6f);
    }
}

// Two objects in one plane that differ by their ids alone, and two by their depths alone.
TEST(Upsample, NothingLeaksBetweenObjects) {
  for (const bool by_id : {true, false}) {
    const int width = 96, height = 40;
    test::Random random(33);
    Guides guides = test::wall(test::perspective_camera(width, height), width, height);
    for (int y = 0; y < height; ++y)
      for (int x = 9 + y % 2; x < width; ++x)
        test::set_pixel(guides, x, y, by_id ? 5.0f : 25.0f, {0, 0, 1}, by_id ? 2u : 1u);
    World world(std::move(guides), random);
    const auto is_near = [&](const Guides& g, int x, int y) {
      return g.id[0].at(x, y) == 1u && g.depth().at(x, y) < 10.0f;
    };
    for (int y = 0; y < world.half.view.height; ++y)
      for (int x = 0; x < world.half.view.width; ++x)
        world.in[0].at(x, y) = is_near(world.half, x, y) ? 1.0f : 100.0f;
    world.run(1);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)
        ASSERT_NEAR(world.out[0].at(x, y), is_near(world.full, x, y) ? 1.0f : 100.0f, 1e-4f)
            << (by_id ? "id" : "depth") << " at " << x << ", " << y;
  }
}

TEST(Upsample, APixelThatNoNeighbourResemblesTakesTheMostSimilarNearby) {
  const int width = 12, height = 12;
  test::Random random(34);
  Guides guides = test::wall(test::perspective_camera(width, height), width, height);
  // One pixel of object 2, outvoted in its quad, whose like is two half pixels away.
  test::set_pixel(guides, 4, 4, 5.0f, {0, 0, 1}, 2);
  for (int y = 4; y < 6; ++y)
    for (int x = 8; x < 10; ++x) test::set_pixel(guides, x, y, 5.0f, {0, 0, 1}, 2);
  // One that has no like anywhere.
  test::set_pixel(guides, 0, 10, 5.0f, {0, 0, 1}, 3);
  World world(std::move(guides), random);
  test::fill(world.in[0], 0.25f);
  world.in[0].at(4, 2) = 0.75f;
  world.run(1);
  EXPECT_EQ(world.out[0].at(4, 4), 0.75f);
  EXPECT_EQ(world.out[0].at(0, 10), 0.25f) << "a neighbour's value, whatever it shows";
  EXPECT_NEAR(world.out[0].at(5, 5), 0.25f, 1e-6f);
}

// Beside a large penalty for another id, floats would forget which of two is nearer.
TEST(Upsample, WithoutItsLikeAPixelTakesTheNearestOfTheOthers) {
  const int width = 12, height = 12;
  test::Random random(36);
  Guides guides = test::wall(test::orthographic_camera(width, height), width, height);
  test::set_pixel(guides, 5, 5, 5.0f, {0, 0, 1}, 3);
  World world(std::move(guides), random);
  for (int y = 0; y < 6; ++y)
    for (int x = 0; x < 6; ++x) world.in[0].at(x, y) = x == 2 && y == 2 ? 0.75f : 0.25f;
  world.run(1);
  EXPECT_EQ(world.out[0].at(5, 5), 0.75f);
}

TEST(Upsample, ALinearSignalOnAFlatSurfaceStaysLinearInside) {
  const int width = 20, height = 12;
  test::Random random(35);
  World world(test::wall(test::orthographic_camera(width, height), width, height), random);
  for (int y = 0; y < 6; ++y)
    for (int x = 0; x < 10; ++x)
      world.in[0].at(x, y) = 2.0f * static_cast<float>(x) + static_cast<float>(y);
  world.run(1);
  for (int y = 1; y < height - 1; ++y)
    for (int x = 1; x < width - 1; ++x)
      ASSERT_NEAR(world.out[0].at(x, y),
                  2.0f * (static_cast<float>(x) - 0.5f) / 2 + (static_cast<float>(y) - 0.5f) / 2,
                  1e-4f);
}

}  // namespace
}  // namespace holdfast
