#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "client/stability/entry.h"
#include "client/stability/outcome.h"

namespace holdfast::stability {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr PlaneId kGlossyPlane{PlaneKind::kGlossy, {}}, kIndirectPlane{PlaneKind::kIndirect, {}};
constexpr int kPoisonedFrom = 2, kPoisonedTo = 5;  ///< frames; the last is clean again
constexpr int kRecovered = 69;                     ///< frames of a session that recovers

World still_world(const std::string& recipe, const Histories& histories) {
  World world;
  world.recipe = recipe;
  world.history = histories.format;
  world.still = true;
  return world;
}

Entry brightness(const char* text, double radiance, const Histories& histories) {
  return {histories.name("radiance-" + std::string(text)), "all light times " + std::string(text),
          "as with ordinary light, times " + std::string(text), histories.limit(kScaled, 0.02),
          [=](const std::string& recipe) {
            World world;
            world.recipe = recipe;
            world.history = histories.format;
            const Outcome ordinary = filter_world(world);
            world.radiance = radiance;
            return relative_difference(filter_world(world), ordinary, radiance);
          }};
}

/// Every seventh value of a plane.
void poison(Plane& plane, float bad) {
  for (int c = 0; c < plane.channels(); ++c)
    for (int y = 0; y < plane.height(); ++y)
      for (int x = (3 * y + c) % 7; x < plane.width(); x += 7) plane.channel(c).at(x, y) = bad;
}

/// Poison for three frames against none: finite, counted by name while it lasts and only then, and
/// gone afterwards.
double poison_left(const std::string& recipe, const Histories& histories, PlaneId id, float bad) {
  World world = still_world(recipe, histories);
  const Outcome clean = filter_world(world, kRecovered);
  world.spoil = [=](Frame& frame, int t) {
    if (t >= kPoisonedFrom && t < kPoisonedTo) poison(*frame.planes.find(id), bad);
  };
  const Outcome poisoned = filter_world(world, kRecovered);
  if (!all_finite(poisoned)) return HUGE_VAL;
  for (int t = 0; t < kRecovered; ++t) {
    const bool counted = repaired(poisoned.reports[static_cast<std::size_t>(t)], id) > 0;
    if (counted != (t >= kPoisonedFrom && t < kPoisonedTo)) return HUGE_VAL;
  }
  const PlaneSet mean = truth(world, 0, 256);
  return rmse(poisoned.results.back().at(id), mean.at(id)) /
         rmse(clean.results.back().at(id), mean.at(id));
}

Entry poisoned(const std::string& text, float bad, const Histories& histories) {
  return {
      histories.name("radiance-" + text),
      "a seventh of glossy, indirect and visibility " + text + " for 3 frames",
      "finite; counted by plane while it lasts; gone 64 frames later: error against the truth over "
      "that of a session without it",
      1.1, [=](const std::string& recipe) {
        double worst = 0;
        for (const PlaneId id :
             {kGlossyPlane, kIndirectPlane, PlaneId::of_light(PlaneKind::kVisibility, 0)})
          worst = std::max(worst, poison_left(recipe, histories, id, bad));
        return worst;
      }};
}

/// A single value of a million in one frame: how much brighter any pixel is afterwards.
double firefly_left(const std::string& recipe, const Histories& histories) {
  World world = still_world(recipe, histories);
  const Outcome clean = filter_world(world, kRecovered);
  world.spoil = [](Frame& frame, int t) {
    for (int c = 0; c < 3 && t == 4; ++c)
      frame.planes.find(kIndirectPlane)->channel(c).at(16, 12) = 1e6f;
  };
  const Outcome sparked = filter_world(world, kRecovered);
  if (!all_finite(sparked)) return HUGE_VAL;
  double worst = 0;
  for (int y = 0; y < world.height; ++y)
    for (int x = 0; x < world.width; ++x) {
      const auto at = [&](const Outcome& outcome, std::size_t t) {
        return double{outcome.results[t].at(kIndirectPlane).channel(1).at(x, y)};
      };
      for (std::size_t t = 0; t < sparked.results.size(); ++t)
        if (at(sparked, t) > 1e6) return HUGE_VAL;
      worst = std::max(worst, std::abs(at(sparked, kRecovered - 1) - at(clean, kRecovered - 1)));
    }
  return worst / 1e6;
}

/// Light above the largest that the core takes: its largest, and counted.
double over_the_top(const std::string& recipe, const Histories& histories) {
  World world = still_world(recipe, histories);
  world.radiance = 1e30;
  world.light.radiance = glm::dvec3(0);  // the session itself takes no light of this radiance
  const Outcome outcome = filter_world(world);
  if (!all_finite(outcome)) return HUGE_VAL;
  double worst = 0;
  for (std::size_t t = 0; t < outcome.results.size(); ++t) {
    if (repaired(outcome.reports[t], kIndirectPlane) == 0) return HUGE_VAL;
    const auto plane = outcome.results[t].at(kIndirectPlane).channel(0);
    const float value = plane.at(16, 14);  // on the floor, as all around it
    worst = std::max(worst, std::abs(double{value} / 1e15 - 1));
  }
  return worst;
}

/// Light far below what a float holds in full precision.
double denormal_light(const std::string& recipe, const Histories& histories) {
  World world = still_world(recipe, histories);
  world.radiance = 1e-40;
  const Outcome outcome = filter_world(world);
  if (!all_finite(outcome)) return HUGE_VAL;
  double largest = 0;
  for (const PlaneSet& results : outcome.results)
    for (const PlaneId id : {kGlossyPlane, kIndirectPlane})
      for (int y = 0; y < world.height; ++y)
        for (int x = 0; x < world.width; ++x) {
          const double v = double{results.at(id).channel(0).at(x, y)};
          if (v < 0) return HUGE_VAL;
          largest = std::max(largest, v);
        }
  return largest;
}

}  // namespace

std::vector<Entry> radiance_entries(const Histories& histories) {
  const auto by = [&](double (*error)(const std::string&, const Histories&)) {
    return [=](const std::string& recipe) { return error(recipe, histories); };
  };
  std::vector<Entry> entries{
      brightness("1e-8", 1e-8, histories), brightness("1e-4", 1e-4, histories),
      brightness("1e4", 1e4, histories),   brightness("7e4", 7e4, histories),
      brightness("1e8", 1e8, histories),   brightness("1e12", 1e12, histories)};
  entries[3].input += ", beyond the half floats of the wire";
  entries.push_back({histories.name("radiance-1e30"), "glossy and indirect of 1e30",
                     "the largest radiance, 1e15, relative to it; counted",
                     histories.limit(1e-4, 1e-3), by(over_the_top)});
  entries.push_back({histories.name("radiance-denormal"), "all light 1e-40",
                     "no more than was sent, never negative", 1e-39, by(denormal_light)});
  entries.push_back(poisoned("nan", kNaN, histories));
  entries.push_back(poisoned("inf", kInf, histories));
  entries.push_back(poisoned("-inf", -kInf, histories));
  entries.push_back(poisoned("negative", -2.0f, histories));
  entries.push_back({histories.name("radiance-firefly"), "one sample of 1e6 in one frame",
                     "never brighter than itself; gone 64 frames later, relative to it", 0.02,
                     by(firefly_left)});
  return entries;
}

}  // namespace holdfast::stability
