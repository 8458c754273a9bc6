#include "client/scenes/scene.h"

#include <algorithm>

namespace holdfast::scenes {

bool glows(const Scene& scene) {
  return scene.sky != Sky{} || scene.ambient != glm::dvec3(0.0) ||
         std::any_of(scene.objects.begin(), scene.objects.end(), [](const Object& object) {
           return object.material.emission != glm::dvec3(0.0);
         });
}

}  // namespace holdfast::scenes
