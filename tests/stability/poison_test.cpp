// A client that sends nonsense in one plane for a hundred frames, and then comes to its senses.

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "client/stability/outcome.h"
#include "tests/core/small_world.h"

namespace holdfast::stability {
namespace {

constexpr int kPoisoned = 100, kRecovered = 192;  // frames

using Words = std::vector<std::uint32_t>;

Words words_of(const Plane& plane) {
  Words out;
  for (int c = 0; c < plane.channels(); ++c)
    for (int y = 0; y < plane.height(); ++y)
      out.insert(out.end(), plane.words(c).row(y), plane.words(c).row(y) + plane.width());
  return out;
}

void restore(Plane& plane, const Words& words) {
  std::size_t k = 0;
  for (int c = 0; c < plane.channels(); ++c)
    for (int y = 0; y < plane.height(); ++y)
      for (int x = 0; x < plane.width(); ++x) plane.words(c).at(x, y) = words[k++];
}

/// A fifth of the values, at random places, any of what no renderer should send; ids at random.
void poison(Plane& plane, test::Random& random) {
  constexpr float kBad[] = {test::kNaN, test::kInf, -test::kInf, -3.0f, -1e38f, 1e-45f};
  for (int c = 0; c < plane.channels(); ++c)
    for (int y = 0; y < plane.height(); ++y)
      for (int x = 0; x < plane.width(); ++x) {
        if (random.uniform() >= 0.2) continue;
        if (plane.is_uint())
          plane.ids().at(x, y) = random.bits();
        else
          plane.channel(c).at(x, y) = kBad[random.bits() % std::size(kBad)];
      }
}

double mean_difference(const PlaneSet& a, const PlaneSet& b) {
  double sum = 0, count = 0;
  for (const Plane& plane : a) {
    const double d = rmse(plane, b.at(plane.id()));
    sum += d * d;
    count += 1;
  }
  return std::sqrt(sum / count);
}

class Poison : public testing::TestWithParam<std::string> {
 protected:
  Poison() {
    world.recipe = GetParam();
    world.width = 17;
    world.height = 9;
    world.still = true;
    for (int t = 0; t < kPoisoned + kRecovered; ++t) frames.push_back(render(world, t));
  }

  /// The last frame's results; each frame must be finite, and counted where it had to be repaired.
  PlaneSet run(const DenoiserConfig& config, const PlaneId* poisoned) {
    Denoiser denoiser(config);
    test::Random random(7);
    PlaneSet results;
    for (int t = 0; t < kPoisoned + kRecovered; ++t) {
      Frame& frame = frames[static_cast<std::size_t>(t)];
      const bool poisons = poisoned != nullptr && t < kPoisoned;
      Plane* plane = poisons ? frame.planes.find(*poisoned) : nullptr;
      const Words clean = plane != nullptr ? words_of(*plane) : Words{};
      if (plane != nullptr) poison(*plane, random);
      const FrameReport report = denoiser.filter(frame, results);
      if (plane != nullptr) restore(*plane, clean);
      EXPECT_EQ(report.non_finite_out, 0u) << t;
      EXPECT_LE(relative_difference(results, results), 0) << "a value is not finite in frame " << t;
      EXPECT_TRUE(poisons || report.repaired.empty()) << t;
      for (const RepairCount& count : report.repaired)  // what was sky has no normal
        EXPECT_TRUE(count.plane == *poisoned ||
                    (poisoned->kind == PlaneKind::kDepth && count.plane.kind == PlaneKind::kNormal))
            << plane_name(count.plane);
    }
    return results;
  }

  void expect_recovery(const std::string& preset) {
    DenoiserConfig config = session_of(world);
    config.preset = preset;
    const PlaneSet clean = run(config, nullptr);
    for (const PlaneId id : config.planes) {
      SCOPED_TRACE(preset + " " + plane_name(id));
      EXPECT_LT(mean_difference(run(config, &id), clean), 0.02);
    }
  }

  World world;
  std::vector<Frame> frames;
};

TEST_P(Poison, OfAnyPlaneForAHundredFramesNeverGetsOutAndIsForgotten) {
  expect_recovery("balanced");
  if (world.recipe == "reliable" || world.recipe == "svgf") expect_recovery("fast");
}

INSTANTIATE_TEST_SUITE_P(Recipes, Poison, testing::ValuesIn(recipe_names()),
                         [](const testing::TestParamInfo<std::string>& recipe) {
                           std::string name = recipe.param;
                           for (char& c : name)
                             if (c == '-') c = '_';
                           return name;
                         });

}  // namespace
}  // namespace holdfast::stability
