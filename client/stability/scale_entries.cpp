#include <string>

#include <glm/gtc/matrix_transform.hpp>

#include "client/stability/entry.h"
#include "client/stability/outcome.h"

namespace holdfast::stability {
namespace {

/// Of results of packed histories that are rounded by other draws.
const Limits kRedrawn{0.02, 0.02};

World plain(const std::string& recipe, const Histories& histories) {
  World world;
  world.recipe = recipe;
  world.history = histories.format;
  return world;
}

Entry scaled(const char* metres_text, double metres, const Histories& histories) {
  return {histories.name("scale-" + std::string(metres_text)),
          "the scene in units of " + std::string(metres_text) + " m",
          "as in units of 1 m, relative to each plane's largest value",
          histories.limit(kScaled, kRedrawn), [=](const std::string& recipe) {
            World world = plain(recipe, histories);
            const Outcome ordinary = filter_world(world);
            world.metres = metres;
            return relative_difference(filter_world(world), ordinary);
          }};
}

}  // namespace

std::vector<Entry> scale_entries(const Histories& histories) {
  std::vector<Entry> entries{scaled("1e-4", 1e-4, histories), scaled("1e-2", 1e-2, histories),
                             scaled("1e2", 1e2, histories), scaled("1e4", 1e4, histories),
                             scaled("1e6", 1e6, histories)};
  entries.push_back({histories.name("far-from-origin"),
                     "camera and scene 1e7 m from the world's origin",
                     "as at the origin, relative to each plane's largest value",
                     histories.limit(kScaled, kRedrawn), [=](const std::string& recipe) {
                       World world = plain(recipe, histories);
                       const Outcome ordinary = filter_world(world);
                       world.place = glm::translate(glm::dmat4(1), {1e7, -1e7, 1e7});
                       return relative_difference(filter_world(world), ordinary);
                     }});
  entries.push_back({histories.name("scale-1e6-far"), "units of 1e6 m, 1e7 m from the origin",
                     "as in units of 1 m at the origin", histories.limit(kScaled, kRedrawn),
                     [=](const std::string& recipe) {
                       World world = plain(recipe, histories);
                       const Outcome ordinary = filter_world(world);
                       world.metres = 1e6;
                       world.place = glm::translate(glm::dmat4(1), {1e7, 1e7, -1e7});
                       return relative_difference(filter_world(world), ordinary);
                     }});
  // Cones are laid around a normal by the world's axes.
  entries.push_back(
      {histories.name("turned"), "the world turned by 1 radian about a slanted axis",
       "as it was, but for the samples that cones correct", 0.05, [=](const std::string& recipe) {
         World world = plain(recipe, histories);
         const Outcome ordinary = filter_world(world);
         world.place = glm::rotate(glm::dmat4(1), 1.0, glm::normalize(glm::dvec3(1, 2, 3)));
         return relative_difference(filter_world(world), ordinary);
       }});
  return entries;
}

}  // namespace holdfast::stability
