#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include <glm/gtc/matrix_transform.hpp>

#include "client/stability/entry.h"
#include "client/stability/outcome.h"

namespace holdfast::stability {
namespace {

constexpr double kQuarter = std::numbers::pi / 2;
const PlaneId kVisibilityPlane = PlaneId::of_light(PlaneKind::kVisibility, 0);

glm::dmat4 at(double x, double y, double z) { return glm::translate(glm::dmat4(1), {x, y, z}); }

/// A light at a place, turned about X: -pi/2 emits downwards, pi/2 upwards, 0 towards the wall.
Entry placed(const char* name, const char* input, glm::dvec3 place, double turn,
             const std::function<void(World&)>& change = {}) {
  return {name,
          input,
          "less noise than in the input, relative to it; where it has none, the truth",
          {kHelps, kGhosts},
          [=](const std::string& recipe) {
            World world;
            world.recipe = recipe;
            world.light_place = [=](int) {
              return glm::rotate(at(place.x, place.y, place.z), turn, glm::dvec3(1, 0, 0));
            };
            if (change) change(world);
            return noise_left(world);
          }};
}

/// A light that the floor sees from behind, or edge-on, gives it nothing: the brightest pixel of
/// the floor in the composite without other light, over the light's radiance.
double light_on_dark_floor(const std::string& recipe, glm::dvec3 place, double turn) {
  World world;
  world.recipe = recipe;
  world.light_place = [=](int) {
    return glm::rotate(at(place.x, place.y, place.z), turn, glm::dvec3(1, 0, 0));
  };
  world.spoil = [](Frame& frame, int) {
    for (const PlaneKind kind : {PlaneKind::kGlossy, PlaneKind::kIndirect, PlaneKind::kEmission})
      frame.planes.add({kind, {}}, 1, 1), frame.planes.add({kind, {}}, 33, 17);
  };
  const Outcome outcome = filter_world(world);
  if (!all_finite(outcome)) return HUGE_VAL;
  const Frame last = render(world, kFrames - 1);
  double brightest = 0;
  for (int y = 0; y < world.height; ++y)
    for (int x = 0; x < world.width; ++x)
      if (last.planes.at({PlaneKind::kObjectId, {}}).ids().at(x, y) == kFloorId)
        brightest = std::max(
            brightest,
            double{outcome.results.back().at({PlaneKind::kComposite, {}}).channel(0).at(x, y)});
  return brightest / world.light.radiance.x;
}

/// Lights without size cast shadows without penumbra: the share of pixels that are on the wrong
/// side in the last frame.
double hard_shadow(const std::string& recipe, const std::function<void(Light&)>& shrink,
                   bool still) {
  World world;
  world.recipe = recipe;
  world.still = still;
  shrink(world.light);
  const Outcome outcome = filter_world(world);
  if (!all_finite(outcome)) return HUGE_VAL;
  const PlaneSet mean = truth(world, kFrames - 1, 1);
  double wrong = 0;
  for (int y = 0; y < world.height; ++y)
    for (int x = 0; x < world.width; ++x) {
      const float found = outcome.results.back().at(kVisibilityPlane).channel(0).at(x, y);
      wrong += std::abs(found - mean.at(kVisibilityPlane).channel(0).at(x, y)) > 0.5f ? 1 : 0;
    }
  return wrong / (world.width * world.height);
}

Entry without_size(const char* name, const char* input, const std::function<void(Light&)>& shrink,
                   bool still = true) {
  return {name,
          input,
          "its hard shadow: share of pixels on the wrong side of it",
          {0.01, 0.05},
          [=](const std::string& recipe) { return hard_shadow(recipe, shrink, still); }};
}

}  // namespace

std::vector<Entry> light_entries() {
  return {
      placed("light-in-plane", "a light that lies in the floor's plane", {0.3, -1, -3.5},
             -kQuarter),
      {"light-in-plane-dark", "a light that lies in the floor's plane, beside what is seen",
       "a dark floor: its brightest pixel over the light's radiance", 1e-3,
       [](const std::string& recipe) {
         return light_on_dark_floor(recipe, {0.3, -1, -1.4}, -kQuarter);
       }},
      placed("blocker-on-receiver", "a box that stands halfway in the floor", {0.3, 2, -3.2},
             -kQuarter,
             [](World& world) { world.box = [](int t) { return at(-0.8 + 0.1 * t, -1, -4); }; }),
      placed("blocker-on-light", "a box that the light is halfway in", {0.3, 2, -3.2}, -kQuarter,
             [](World& world) { world.box = [](int t) { return at(-0.4 + 0.1 * t, 2, -3.5); }; }),
      {"light-behind", "a light below the floor that emits downwards",
       "a dark floor: its brightest pixel over the light's radiance", 1e-6,
       [](const std::string& recipe) {
         return light_on_dark_floor(recipe, {0.3, -2, -3.5}, -kQuarter);
       }},
      {"light-turned-away", "a light above the floor that emits upwards",
       "a dark floor: its brightest pixel over the light's radiance", 1e-6,
       [](const std::string& recipe) {
         return light_on_dark_floor(recipe, {0.3, 2, -3.2}, kQuarter);
       }},
      without_size("light-0x0", "a rectangle of 0x0 m",
                   [](Light& light) { light.width = light.height = 0; }),
      without_size("light-0x1", "a rectangle without width and of 1e-6 m",
                   [](Light& light) {
                     light.width = 0;
                     light.height = 1e-6;
                   }),
      without_size("light-sphere-0", "a sphere of radius 0",
                   [](Light& light) {
                     light.shape = LightShape::kSphere;
                     light.radius = 0;
                   }),
      without_size("light-disk-0", "a disk of radius 0",
                   [](Light& light) {
                     light.shape = LightShape::kDisk;
                     light.radius = 0;
                   }),
      without_size("light-sun-0", "a sun of angle 0",
                   [](Light& light) {
                     light.shape = LightShape::kDirectional;
                     light.radius = 0;
                   }),
      without_size(
          "light-0x0-moving", "a rectangle of 0x0 m, and a box that moves",
          [](Light& light) { light.width = light.height = 0; }, false),
      without_size(
          "light-point-moving", "a point, and a box that moves",
          [](Light& light) { light.shape = LightShape::kPoint; }, false),
      without_size(
          "light-1e-6-moving", "a square of 1e-6 m, and a box that moves",
          [](Light& light) { light.width = light.height = 1e-6; }, false),
      {"light-singular", "a light whose matrix is 0", "the other components as without it", 1e-4,
       [](const std::string& recipe) {
         World world;
         world.recipe = recipe;
         const Outcome ordinary = filter_world(world);
         world.spoil = [](Frame& frame, int) { frame.lights[0] = glm::dmat4(0); };
         Outcome outcome = filter_world(world);
         if (!all_finite(outcome)) return HUGE_VAL;
         for (PlaneSet& results : outcome.results) {
           results.remove(kVisibilityPlane);
           results.remove({PlaneKind::kComposite, {}});
         }
         return relative_difference(outcome, ordinary);
       }}};
}

}  // namespace holdfast::stability
