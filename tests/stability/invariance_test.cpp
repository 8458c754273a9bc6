#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include "client/stability/outcome.h"

/// What must not matter. Where arithmetic is exact under the change, results have the same bits.
namespace holdfast::stability {
namespace {

class Invariance : public testing::TestWithParam<std::string> {
 protected:
  World world() const {
    World world;
    world.recipe = GetParam();
    return world;
  }
};

TEST_P(Invariance, OfTheUnitOfLengthByPowersOfTwo) {
  World changed = world();
  const Outcome ordinary = filter_world(changed);
  for (const double metres : {0x1p-20, 0x1p-3, 0x1p20}) {
    changed.metres = metres;
    EXPECT_EQ(relative_difference(filter_world(changed), ordinary), 0) << metres;
  }
}

// But for the constants that keep divisions from zero, which weigh nothing at these scales.
TEST_P(Invariance, OfTheUnitOfRadianceByPowersOfTwo) {
  World changed = world();
  const Outcome ordinary = filter_world(changed);
  for (const double radiance : {0x1p-20, 0x1p3, 0x1p20}) {
    changed.radiance = radiance;
    EXPECT_LE(relative_difference(filter_world(changed), ordinary, radiance), 1e-5) << radiance;
  }
}

TEST_P(Invariance, OfThePlaceInTheWorld) {
  World changed = world();
  const Outcome ordinary = filter_world(changed);
  changed.place = glm::translate(glm::dmat4(1), {-310.0, 1200.0, 77.0});
  EXPECT_LE(relative_difference(filter_world(changed), ordinary), 1e-4);
}

// Cones are laid around a normal by the world's axes: `paper` and `reliable` may differ by what
// they correct.
TEST_P(Invariance, OfTheDirectionInTheWorld) {
  World changed = world();
  const Outcome ordinary = filter_world(changed);
  changed.place = glm::rotate(glm::dmat4(1), 2.0, glm::normalize(glm::dvec3(-1, 0.5, 2)));
  const bool cones = GetParam() == "reliable" || GetParam().rfind("paper", 0) == 0;
  EXPECT_LE(relative_difference(filter_world(changed), ordinary), cones ? 0.05 : 1e-3);
}

TEST_P(Invariance, OfTheNamesOfObjects) {
  World changed = world();
  const Outcome ordinary = filter_world(changed);
  changed.floor_id = 4000000000u;
  changed.wall_id = 7;
  changed.box_id = 5;
  EXPECT_EQ(relative_difference(filter_world(changed), ordinary), 0);
}

/// Gives the right half of the wall another id, wherever it is named.
void split_wall(Frame& frame, const World& world) {
  const auto ids = frame.planes.find({PlaneKind::kObjectId, {}})->ids();
  for (int y = 0; y < world.height; ++y)
    for (int x = world.width / 2; x < world.width; ++x)
      if (ids.at(x, y) == kWallId) ids.at(x, y) = 9;
}

// A surface may be one object or two: away from the seam nothing changes. The camera rests, so that
// the seam lies between the same pixels in every frame.
TEST_P(Invariance, OfSplittingAnObjectInTwo) {
  World changed = world();
  changed.still = true;
  const Outcome ordinary = filter_world(changed);
  changed.spoil = [&](Frame& frame, int) { split_wall(frame, changed); };
  // Published reflection vectors lead to other places of the wall even at rest, across the seam.
  const bool scattered = GetParam().rfind("specular", 0) == 0 || GetParam().rfind("paper", 0) == 0;
  EXPECT_LE(relative_difference(filter_world(changed), ordinary), scattered ? 0.15 : 0);
}

TEST_P(Invariance, OfALightThatLightsNothing) {
  World changed = world();
  const Outcome ordinary = filter_world(changed);
  changed.more_lights = {{5, LightShape::kSphere, 0, 0, 1.0, glm::dvec3(1000)}};
  changed.spoil = [](Frame& frame, int t) {
    frame.lights[5] = glm::translate(glm::dmat4(1), {0.0, 1.0 * t, 0.0});
  };
  EXPECT_EQ(relative_difference(filter_world(changed), ordinary), 0);
}

TEST_P(Invariance, OfAnObjectThatIsNotSeen) {
  World changed = world();
  const Outcome ordinary = filter_world(changed);
  changed.spoil = [](Frame& frame, int t) {
    frame.objects[77] = glm::translate(glm::dmat4(1), {0.5 * t, 0.0, 0.0});
  };
  EXPECT_EQ(relative_difference(filter_world(changed), ordinary), 0);
}

/// Mean of a channel over an image.
double mean_of(const Plane& plane, int c) {
  double sum = 0;
  for (int y = 0; y < plane.height(); ++y)
    for (int x = 0; x < plane.width(); ++x) sum += double{plane.channel(c).at(x, y)};
  return sum / (static_cast<double>(plane.width()) * plane.height());
}

// With four times the samples of the same content, less noise is left and the light is the same, to
// the noise of a mean over 33x17 samples.
TEST_P(Invariance, OfTheResolutionButForNoise) {
  World changed = world();
  const Outcome ordinary = filter_world(changed);
  const double noise = noise_left(changed);
  changed.width *= 2;
  changed.height *= 2;
  const Outcome fine = filter_world(changed);
  EXPECT_LE(noise_left(changed), 1.2 * noise);
  for (const Plane& plane : ordinary.results.back())
    for (int c = 0; c < plane.channels(); ++c) {
      const double mean = mean_of(plane, c);
      EXPECT_NEAR(mean_of(fine.results.back().at(plane.id()), c), mean, 0.1 * mean)
          << plane_name(plane.id());
    }
}

TEST_P(Invariance, OfThreadsAndOfWhatElseRunsOnThem) {
  World changed = world();
  changed.height = 41;  // several tasks of rows, the last one short
  const Outcome ordinary = filter_world(changed);
  for (const int threads : {1, 2, 5}) {
    const tbb::global_control most(tbb::global_control::max_allowed_parallelism, 5);
    tbb::task_arena arena(threads);
    Outcome outcome;
    arena.execute([&] { outcome = filter_world(changed); });
    EXPECT_EQ(relative_difference(outcome, ordinary), 0) << threads;
  }
}

INSTANTIATE_TEST_SUITE_P(Recipes, Invariance, testing::ValuesIn(recipe_names()),
                         [](const testing::TestParamInfo<std::string>& recipe) {
                           std::string name = recipe.param;
                           for (char& c : name)
                             if (c == '-') c = '_';
                           return name;
                         });

}  // namespace
}  // namespace holdfast::stability
