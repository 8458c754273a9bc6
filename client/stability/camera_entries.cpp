#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include <glm/gtc/matrix_transform.hpp>

#include "client/stability/entry.h"
#include "client/stability/outcome.h"
#include "core/frame/error.h"

namespace holdfast::stability {
namespace {

constexpr int kTurnedAt = 5;

Entry field_of_view(int degrees) {
  return {"fov-" + std::to_string(degrees),
          "a field of view of " + std::to_string(degrees) + " degrees",
          "less noise than in the input, relative to it; no more where all is detail of a pixel",
          {1.05, kGhosts},
          [=](const std::string& recipe) {
            World world;
            world.recipe = recipe;
            world.fov = degrees * std::numbers::pi / 180;
            world.width = 97;
            world.height = 55;
            return noise_left(world);
          }};
}

Entry depth_range(const char* name, const char* input, double near, double far) {
  return {name,
          input,
          "as with 0.1 m to 100 m, relative to each plane's largest value",
          {1e-4, 1e-3},
          [=](const std::string& recipe) {
            World world;
            world.recipe = recipe;
            const Outcome ordinary = filter_world(world);
            world.near = near;
            world.far = far;
            return relative_difference(filter_world(world), ordinary);
          }};
}

/// The camera turns round: what it sees was behind it. As if a cut had been announced.
double turned_round(const std::string& recipe) {
  World world;
  world.recipe = recipe;
  world.camera = [](int t) {
    const glm::dmat4 place = glm::translate(glm::dmat4(1), {0.3, 0.2, t < kTurnedAt ? 2.0 : 1.0});
    return t < kTurnedAt ? glm::rotate(place, std::numbers::pi, glm::dvec3(0, 1, 0)) : place;
  };
  world.box = [](int) { return glm::translate(glm::dmat4(1), {-0.8, -0.2, -5}); };
  const Outcome turned = filter_world(world, kTurnedAt + 1);
  world.spoil = [](Frame& frame, int t) { frame.cut = t == kTurnedAt; };
  const Outcome cut = filter_world(world, kTurnedAt + 1);
  if (!all_finite(turned)) return HUGE_VAL;
  return relative_difference(turned.results.back(), cut.results.back());
}

/// A camera without an inverse is refused, by name, and what follows is as if it had not been sent.
double refused_camera(const std::string& recipe) {
  World world;
  world.recipe = recipe;
  Denoiser disturbed(session_of(world)), undisturbed(session_of(world));
  double worst = 0;
  for (int t = 0; t < kFrames; ++t) {
    PlaneSet a, b;
    const Frame frame = render(world, t);
    Frame flat = render(world, t);
    flat.camera.view_from_world[t % 4] = glm::dvec4(0);
    try {
      disturbed.filter(flat, a);
      return HUGE_VAL;
    } catch (const InputError& error) {
      if (error.subject() != "camera viewFromWorld") return HUGE_VAL;
    }
    disturbed.filter(frame, a);
    undisturbed.filter(frame, b);
    worst = std::max(worst, relative_difference(a, b));
  }
  return worst;
}

}  // namespace

std::vector<Entry> camera_entries() {
  std::vector<Entry> entries;
  for (const int degrees : {1, 10, 90, 150, 170}) entries.push_back(field_of_view(degrees));
  entries.push_back(depth_range("depth-range-wide", "depths from 1e-3 m to 1e6 m", 1e-3, 1e6));
  entries.push_back(
      depth_range("depth-range-reversed", "depth reversed, 100 m to 0.1 m", 100, 0.1));
  entries.push_back(
      depth_range("depth-range-wide-reversed", "depth reversed, 1e6 m to 1e-3 m", 1e6, 1e-3));
  entries.push_back({"behind-previous-camera",
                     "the camera turns round and moves",
                     "as after a cut, relative to each plane's largest value",
                     {1e-4, 1e-3},
                     turned_round});
  entries.push_back({"camera-singular", "each frame first with a camera that has no inverse",
                     "refused by name; then as if it had not been sent", 0, refused_camera});
  return entries;
}

}  // namespace holdfast::stability
