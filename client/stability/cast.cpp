#include "client/stability/cast.h"

#include <cmath>
#include <utility>

namespace holdfast::stability {
namespace {

constexpr double kLeast = 1e-6;  ///< a ray does not meet what it starts on

void keep_nearer(std::optional<Hit>& best, const Hit& hit) {
  if (hit.distance > kLeast && (!best || hit.distance < best->distance)) best = hit;
}

/// Entry into, or exit from, the cube -1/2..1/2. `direction` need not be of unit length, so that
/// distances are those of the scene.
void cast_box(std::optional<Hit>& best, glm::dvec3 from, glm::dvec3 direction,
              const glm::dmat4& box_from_scene, std::uint32_t id) {
  double enter = -HUGE_VAL, leave = HUGE_VAL;
  int enter_axis = 0, leave_axis = 0;
  for (int axis = 0; axis < 3; ++axis) {
    if (direction[axis] == 0) {
      if (std::abs(from[axis]) > 0.5) return;
      continue;
    }
    double a = (-0.5 - from[axis]) / direction[axis], b = (0.5 - from[axis]) / direction[axis];
    if (a > b) std::swap(a, b);
    if (a > enter) enter = a, enter_axis = axis;
    if (b < leave) leave = b, leave_axis = axis;
  }
  if (enter > leave) return;
  const bool outside = enter > kLeast;
  glm::dvec3 normal(0);
  const int axis = outside ? enter_axis : leave_axis;
  normal[axis] = direction[axis] > 0 ? -1 : 1;
  normal = glm::normalize(glm::transpose(glm::dmat3(box_from_scene)) * normal);
  keep_nearer(best, {outside ? enter : leave, normal, id});
}

}  // namespace

Surfaces::Surfaces(const World& world, const glm::dmat4& scene_from_box) : world_(world) {
  has_box_ = std::isnormal(glm::determinant(scene_from_box));
  if (has_box_) box_from_scene_ = glm::inverse(scene_from_box);
}

std::optional<Hit> Surfaces::cast(glm::dvec3 from, glm::dvec3 direction) const {
  std::optional<Hit> best;
  if (direction.y != 0)
    keep_nearer(best,
                {(-1 - from.y) / direction.y, {0, direction.y < 0 ? 1 : -1, 0}, world_.floor_id});
  if (direction.z != 0) {
    const double distance = (-6 - from.z) / direction.z;
    if (from.y + distance * direction.y < 1.5)
      keep_nearer(best, {distance, {0, 0, direction.z < 0 ? 1 : -1}, world_.wall_id});
  }
  if (has_box_)
    cast_box(best, glm::dvec3(box_from_scene_ * glm::dvec4(from, 1)),
             glm::dmat3(box_from_scene_) * direction, box_from_scene_, world_.box_id);
  return best;
}

glm::dvec3 Surfaces::radiance(glm::dvec3 from, glm::dvec3 direction,
                              const std::optional<Hit>& hit) const {
  if (!hit) return world_.radiance * glm::dvec3(0.3, 0.4, 0.6);
  const glm::dvec3 at = from + hit->distance * direction;
  const double pattern = 0.6 + 0.4 * std::sin(3 * at.x) * std::sin(2 * at.z + at.y);
  const glm::dvec3 colour = hit->id == world_.floor_id  ? glm::dvec3(0.5, 0.5, 0.5)
                            : hit->id == world_.wall_id ? glm::dvec3(0.2, 0.6, 0.3)
                                                        : glm::dvec3(0.9, 0.3, 0.2);
  return world_.radiance * pattern * colour;
}

}  // namespace holdfast::stability
