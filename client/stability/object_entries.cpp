#include <cmath>
#include <numbers>
#include <string>

#include <glm/gtc/matrix_transform.hpp>

#include "client/stability/entry.h"
#include "client/stability/outcome.h"

namespace holdfast::stability {
namespace {

constexpr int kEvent = kFrames - 1;  ///< frame in which it happens; the last one

glm::dmat4 at(double x, double y, double z) { return glm::translate(glm::dmat4(1), {x, y, z}); }

/// Something happens to the box in the last frame.
Entry happening(const char* name, const char* input, const std::function<glm::dmat4(int)>& box) {
  return {name,
          input,
          "no ghost: less noise than in the input, relative to it",
          {kHelps, kGhosts},
          [=](const std::string& recipe) {
            World world;
            world.recipe = recipe;
            world.box = box;
            return noise_left(world);
          }};
}

/// A matrix of the floor that no object can have: its pixels lose their history, no others do.
double singular_floor(const std::string& recipe) {
  World world;
  world.recipe = recipe;
  world.spoil = [](Frame& frame, int t) {
    frame.objects[kFloorId] = glm::dmat4(1);
    if (t == kEvent) frame.objects[kFloorId][t % 4] = glm::dvec4(0);
  };
  return noise_left(world);
}

}  // namespace

std::vector<Entry> object_entries() {
  const glm::dmat4 away = at(0, 50, 0), here = at(0, -0.3, -4);
  return {happening("object-appears", "the box appears",
                    [=](int t) { return t < kEvent ? away : here; }),
          happening("object-vanishes", "the box vanishes",
                    [=](int t) { return t < kEvent ? here : away; }),
          happening("object-teleports", "the box is somewhere else in each frame",
                    [](int t) { return at(t % 2 == 0 ? -1.2 : 1.0, -0.3, -4.0 + 0.5 * (t % 3)); }),
          happening("object-spins", "the box turns by 180 degrees each frame",
                    [=](int t) {
                      return glm::rotate(here, std::numbers::pi * t, glm::dvec3(0.6, 0.8, 0));
                    }),
          happening("object-scaled-by-zero", "the box is scaled by zero",
                    [=](int t) { return t < kEvent ? here : glm::scale(here, glm::dvec3(0)); }),
          happening("object-from-zero", "the box grows from zero",
                    [=](int t) { return t < kEvent ? glm::scale(here, glm::dvec3(0)) : here; }),
          happening("object-mirrored", "the box is mirrored each frame",
                    [=](int t) {
                      return glm::scale(here, {t % 2 == 0 ? 1.0 : -1.0, 1, 1});
                    }),
          {"object-singular",
           "the floor's matrix loses a column",
           "less noise than in the input, relative to it",
           {kHelps, kGhosts},
           singular_floor}};
}

}  // namespace holdfast::stability
