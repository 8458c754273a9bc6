#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <glm/gtc/matrix_transform.hpp>

#include "client/stability/entry.h"
#include "client/stability/outcome.h"
#include "core/frame/conventions.h"

namespace holdfast::stability {
namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr PlaneId kGlossyPlane{PlaneKind::kGlossy, {}}, kHits{PlaneKind::kGlossyHitDistance, {}};
const PlaneId kVisibilityPlane = PlaneId::of_light(PlaneKind::kVisibility, 0);
const PlaneId kBlockers = PlaneId::of_light(PlaneKind::kBlockerDistance, 0);

Entry rough(const char* text, float roughness) {
  return {"roughness-" + std::string(text),
          "roughness " + std::string(text) + " everywhere",
          "reflections with less noise than in the input, relative to it",
          {kHelps, kGhosts},
          [=](const std::string& recipe) {
            World world;
            world.recipe = recipe;
            world.roughness = roughness;
            return noise_left(world, kFrames, kGlossyPlane);
          }};
}

/// All normals replaced, where there is a surface.
void set_normals(Frame& frame, const World& world, int t,
                 const std::function<glm::dvec3(glm::dvec3 to_viewer)>& normal_of) {
  const glm::dmat4 camera = world.camera(t);
  const double half = std::tan(world.fov / 2);
  const Plane& depth = frame.planes.at({PlaneKind::kDepth, {}});
  Plane& plane = *frame.planes.find({PlaneKind::kNormal, {}});
  for (int y = 0; y < world.height; ++y)
    for (int x = 0; x < world.width; ++x) {
      if (!is_surface(depth.channel(0).at(x, y))) continue;
      const double dx = ((x + 0.5) / world.width * 2 - 1) * half * world.width / world.height;
      const double dy = (1 - (y + 0.5) / world.height * 2) * half;
      const glm::dvec3 normal =
          normal_of(-glm::normalize(glm::dmat3(camera) * glm::dvec3(dx, dy, -1)));
      for (int c = 0; c < 3; ++c) plane.channel(c).at(x, y) = static_cast<float>(normal[c]);
    }
}

double zero_normals(const std::string& recipe) {
  World world;
  world.recipe = recipe;
  world.spoil = [&world](Frame& frame, int t) {
    set_normals(frame, world, t, [](glm::dvec3) { return glm::dvec3(0); });
  };
  const Outcome outcome = filter_world(world);
  std::uint64_t surfaces = 0;
  const Frame last = render(world, kFrames - 1);
  for (int y = 0; y < world.height; ++y)
    for (int x = 0; x < world.width; ++x)
      surfaces += is_surface(last.planes.at({PlaneKind::kDepth, {}}).channel(0).at(x, y)) ? 1 : 0;
  if (repaired(outcome.reports.back(), {PlaneKind::kNormal, {}}) != surfaces) return HUGE_VAL;
  return noise_left(world);
}

double tangent_normals(const std::string& recipe) {
  World world;
  world.recipe = recipe;
  world.spoil = [&world](Frame& frame, int t) {
    set_normals(frame, world, t, [](glm::dvec3 to_viewer) {
      return glm::normalize(glm::cross(to_viewer, glm::dvec3(0.3, 1, 0.2)));
    });
  };
  return noise_left(world);
}

/// All distances of a plane replaced; how its component fares.
Entry distances(const char* name, const char* input, PlaneId distance, PlaneId component,
                float metres, double limit) {
  return {name,
          input,
          "less noise than in the input, relative to it",
          {limit, kGhosts},
          [=](const std::string& recipe) {
            World world;
            world.recipe = recipe;
            world.spoil = [=](Frame& frame, int) {
              const auto channel = frame.planes.find(distance)->channel(0);
              for (int y = 0; y < channel.height; ++y)
                std::fill_n(channel.row(y), channel.width, metres);
            };
            return noise_left(world, kFrames, component);
          }};
}

/// Nothing but sky: emission alone, to the last bit.
double all_sky(const std::string& recipe) {
  World world;
  world.recipe = recipe;
  world.camera = [](int t) {
    return glm::rotate(glm::dmat4(1), 1.5 + 0.01 * t, glm::dvec3(1, 0, 0));
  };
  const Outcome outcome = filter_world(world);
  if (!all_finite(outcome)) return HUGE_VAL;
  PlaneSet expected, composite;
  const PlaneId id{PlaneKind::kComposite, {}};
  const Frame last = render(world, kFrames - 1);
  for (int c = 0; c < 3; ++c)
    for (int y = 0; y < world.height; ++y)
      for (int x = 0; x < world.width; ++x) {
        composite.add(id, world.width, world.height).channel(c).at(x, y) =
            outcome.results.back().at(id).channel(c).at(x, y);
        expected.add(id, world.width, world.height).channel(c).at(x, y) =
            last.planes.at({PlaneKind::kEmission, {}}).channel(c).at(x, y);
      }
  return relative_difference(composite, expected);
}

/// Each frame shows a place that no frame before showed, without a cut being announced.
double all_changed(const std::string& recipe) {
  World world;
  world.recipe = recipe;
  world.camera = [](int t) { return glm::translate(glm::dmat4(1), {40.0 * t, 0, 0}); };
  return noise_left(world);
}

}  // namespace

std::vector<Entry> surface_entries() {
  // Shadows without a known blocker have no footprint: they are blurred more than they should be.
  Entry unknown_blockers =
      distances("blocker-distance-inf", "blocked samples whose blockers are infinitely far",
                kBlockers, kVisibilityPlane, kInf, 1.5);
  unknown_blockers.expected = "noise and blur together little more than the noise in the input";
  return {
      rough("0", 0),
      rough("1", 1),
      {"normal-zero",
       "normals of zero length",
       "all surfaces counted as repaired; less noise than in the input, relative to it",
       {kHelps, kGhosts},
       zero_normals},
      {"normal-tangent",
       "normals at right angles to the view",
       "less noise than in the input, relative to it",
       {kHelps, kGhosts},
       tangent_normals},
      distances("hit-distance-0", "all reflected hits at 0 m", kHits, kGlossyPlane, 0.0f, kHelps),
      distances("hit-distance-inf", "all reflected hits infinitely far", kHits, kGlossyPlane, kInf,
                kHelps),
      distances("blocker-distance-0", "all blockers at 0 m", kBlockers, kVisibilityPlane, 0.0f,
                kHelps),
      unknown_blockers,
      {"all-sky", "no surface in any frame", "emission, relative to its largest value", 0, all_sky},
      {"all-changed",
       "each frame shows another place, no cut announced",
       "less noise than in the input, relative to it",
       {kHelps, kGhosts},
       all_changed}};
}

}  // namespace holdfast::stability
