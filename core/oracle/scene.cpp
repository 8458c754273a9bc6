#include "core/oracle/scene.h"

#include <algorithm>
#include <cmath>

#include <glm/gtc/matrix_inverse.hpp>

namespace holdfast::oracle {

void Scene::advance(const Frame& frame, int width, int height) {
  const ViewGeometry next(frame.camera, width, height);
  const bool first = !has_past_;
  camera_at_rest_ = !first && frame.camera.view_from_world == camera_.view_from_world &&
                    frame.camera.clip_from_view == camera_.clip_from_view;
  previous_view_ = first ? next : view_;
  view_ = next;
  camera_ = frame.camera;
  const bool new_object = follow(objects_, frame.objects, first);
  const bool new_light = follow(lights_, frame.lights, first);
  appeared_ = new_object || new_light;
  has_past_ = true;
  static_ = motion_of(Track{});
  moving_.clear();
  geometry_still_ = true;
  for (const auto& [id, track] : objects_) {
    const bool moves = track.now != track.before;
    geometry_still_ = geometry_still_ && !moves;
    if (moves || track.appeared) moving_[id] = motion_of(track);
  }
}

/// What appears has been where it is. Returns whether something did.
bool Scene::follow(Tracks& tracks, const TransformTable& moved, bool first) {
  bool appeared = false;
  for (auto& [id, track] : tracks) {
    track.before = track.now;
    track.appeared = false;
  }
  for (const auto& [id, matrix] : moved) {
    const bool is_new = !tracks.contains(id);
    Track& track = tracks[id];
    track.now = matrix;
    if (is_new || first) track.before = matrix;
    track.appeared = is_new && !first;
    appeared |= is_new;
  }
  return appeared;
}

Motion Scene::motion_of(const Track& track) const {
  Motion motion;
  motion.appeared = track.appeared;
  motion.origin = view_.origin;
  motion.previous_origin = previous_view_.origin;
  const double volume = glm::determinant(glm::dmat3(track.now));
  const double volume_before = glm::determinant(glm::dmat3(track.before));
  if (!std::isfinite(1 / volume) || !std::isfinite(1 / volume_before)) {
    motion.traceable = false;
    return motion;
  }
  const bool still = track.now == track.before;
  if (!still) {
    motion.previous_from_now = track.before * glm::inverse(track.now);
    motion.now_from_previous = track.now * glm::inverse(track.before);
  }
  motion.normal = glm::inverseTranspose(glm::dmat3(motion.previous_from_now));
  motion.at_rest = still && camera_at_rest_;
  return motion;
}

Scene Scene::halved() const {
  Scene half = *this;
  half.view_ = view_.halved();
  half.previous_view_ = previous_view_.halved();
  return half;
}

const Motion& Scene::motion(std::uint32_t object_id) const {
  const auto found = moving_.find(object_id);
  return found == moving_.end() ? static_ : found->second;
}

LightPlaces Scene::light(std::uint32_t light_id) const {
  const auto found = lights_.find(light_id);
  const Track track = found == lights_.end() ? Track{} : found->second;
  LightPlaces places{track.now, track.before, track.now == track.before};
  places.now[3] -= glm::dvec4(view_.origin, 0);
  places.then[3] -= glm::dvec4(previous_view_.origin, 0);
  return places;
}

bool Scene::at_rest() const {
  return geometry_at_rest() && !appeared_ &&
         std::all_of(lights_.begin(), lights_.end(),
                     [](const auto& light) { return light.second.now == light.second.before; });
}

}  // namespace holdfast::oracle
