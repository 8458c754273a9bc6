#include <string>

#include <glm/gtc/matrix_transform.hpp>

#include "client/stability/entry.h"
#include "client/stability/outcome.h"

namespace holdfast::stability {
namespace {

World plain(const std::string& recipe) {
  World world;
  world.recipe = recipe;
  return world;
}

Entry scaled(const char* metres_text, double metres) {
  return {"scale-" + std::string(metres_text),
          "the scene in units of " + std::string(metres_text) + " m",
          "as in units of 1 m, relative to each plane's largest value",
          {1e-4, 1e-3},
          [=](const std::string& recipe) {
            World world = plain(recipe);
            const Outcome ordinary = filter_world(world);
            world.metres = metres;
            return relative_difference(filter_world(world), ordinary);
          }};
}

}  // namespace

std::vector<Entry> scale_entries() {
  std::vector<Entry> entries{scaled("1e-4", 1e-4), scaled("1e-2", 1e-2), scaled("1e2", 1e2),
                             scaled("1e4", 1e4), scaled("1e6", 1e6)};
  entries.push_back({"far-from-origin",
                     "camera and scene 1e7 m from the world's origin",
                     "as at the origin, relative to each plane's largest value",
                     {1e-4, 1e-3},
                     [](const std::string& recipe) {
                       World world = plain(recipe);
                       const Outcome ordinary = filter_world(world);
                       world.place = glm::translate(glm::dmat4(1), {1e7, -1e7, 1e7});
                       return relative_difference(filter_world(world), ordinary);
                     }});
  entries.push_back({"scale-1e6-far",
                     "units of 1e6 m, 1e7 m from the origin",
                     "as in units of 1 m at the origin",
                     {1e-4, 1e-3},
                     [](const std::string& recipe) {
                       World world = plain(recipe);
                       const Outcome ordinary = filter_world(world);
                       world.metres = 1e6;
                       world.place = glm::translate(glm::dmat4(1), {1e7, 1e7, -1e7});
                       return relative_difference(filter_world(world), ordinary);
                     }});
  // Cones are laid around a normal by the world's axes.
  entries.push_back(
      {"turned", "the world turned by 1 radian about a slanted axis",
       "as it was, but for the samples that cones correct", 0.05, [](const std::string& recipe) {
         World world = plain(recipe);
         const Outcome ordinary = filter_world(world);
         world.place = glm::rotate(glm::dmat4(1), 1.0, glm::normalize(glm::dvec3(1, 2, 3)));
         return relative_difference(filter_world(world), ordinary);
       }});
  return entries;
}

}  // namespace holdfast::stability
