#include "core/frame/scene_motion.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include <glm/gtc/matrix_inverse.hpp>

#include "core/frame/error.h"

namespace holdfast {
namespace {

void check_finite(const TransformTable& table, const char* what) {
  for (const auto& [id, matrix] : table)
    for (int c = 0; c < 4; ++c)
      for (int r = 0; r < 4; ++r)
        if (!std::isfinite(matrix[c][r]))
          throw InputError("transform of " + std::string(what) + " " + std::to_string(id),
                           "must be finite", std::to_string(matrix[c][r]));
}

void check_lights(const TransformTable& table, const std::vector<Light>& known) {
  for (const auto& [id, matrix] : table) {
    const bool found = std::any_of(known.begin(), known.end(),
                                   [&, wanted = id](const Light& l) { return l.id == wanted; });
    if (!found)
      throw InputError("light " + std::to_string(id), "must be a light of the session", "unknown");
  }
}

}  // namespace

void SceneMotion::advance(const Frame& frame, int width, int height,
                          const std::vector<Light>& known_lights) {
  check_finite(frame.objects, "object");
  check_finite(frame.lights, "light");
  check_lights(frame.lights, known_lights);
  const ViewGeometry next(frame.camera, width, height);

  const bool first = !has_past_;
  camera_at_rest_ = !first && frame.camera.view_from_world == view_matrix_ &&
                    frame.camera.clip_from_view == clip_matrix_;
  previous_view_ = first ? next : view_;
  view_ = next;
  view_matrix_ = frame.camera.view_from_world;
  clip_matrix_ = frame.camera.clip_from_view;
  appeared_ids_ = follow(object_tracks_, frame.objects, first);
  const bool new_light = !follow(light_tracks_, frame.lights, first).empty();
  appeared_ = !appeared_ids_.empty() || new_light;
  if (first) appeared_ids_.clear();  // before it nothing is known of anything
  has_past_ = true;
  ++frames_;
  forget_oldest();

  slot_ids_.clear();
  objects_.assign(1, compose(Track{}));
  geometry_at_rest_ = objects_[0].at_rest;
  for (const auto& [id, track] : object_tracks_) {
    if (track.now == track.before) continue;  // as slot 0
    slot_ids_.push_back(id);
    objects_.push_back(compose(track));
    geometry_at_rest_ = false;
  }
  objects_.push_back(objects_[0]);  // what appears has been where it is
  objects_.back().appeared = true;
}

/// Clients may name new objects for ever.
void SceneMotion::forget_oldest() {
  if (object_tracks_.size() <= kMostObjects) return;
  std::vector<std::uint64_t> listed;
  for (const auto& [id, track] : object_tracks_) listed.push_back(track.listed);
  // A quarter more than must go, so that it is not done for each new object.
  const auto kept = listed.begin() + static_cast<std::ptrdiff_t>(kMostObjects / 4 * 3);
  std::nth_element(listed.begin(), kept, listed.end(), std::greater<>());
  const std::uint64_t oldest = *kept, now = frames_ - 1;
  std::erase_if(object_tracks_, [&](const auto& track) {
    return track.second.listed <= oldest && track.second.listed != now;
  });
}

void SceneMotion::follow_halved(const SceneMotion& full) {
  light_tracks_ = full.light_tracks_;  // of objects only those that move now are asked for
  slot_ids_ = full.slot_ids_;
  appeared_ids_ = full.appeared_ids_;
  objects_ = full.objects_;
  geometry_at_rest_ = full.geometry_at_rest_;
  appeared_ = full.appeared_;
  view_ = full.view_.halved();
  previous_view_ = full.previous_view_.halved();
  for (ObjectMotion<float>& object : objects_) {
    object.prev_pixel = halved_pixels(object.prev_pixel);
    object.next_pixel = halved_pixels(object.next_pixel);
  }
}

void SceneMotion::resize(int width, int height) {
  if (has_past_) view_ = ViewGeometry({view_matrix_, clip_matrix_, {}}, width, height);
}

void SceneMotion::reset() { *this = SceneMotion(); }

bool SceneMotion::at_rest() const {
  return geometry_at_rest_ && !appeared_ &&
         std::all_of(light_tracks_.begin(), light_tracks_.end(),
                     [](const auto& light) { return light.second.now == light.second.before; });
}

int SceneMotion::slot_of(std::uint32_t object_id) const {
  const auto it = std::lower_bound(slot_ids_.begin(), slot_ids_.end(), object_id);
  if (it != slot_ids_.end() && *it == object_id)
    return static_cast<int>(it - slot_ids_.begin()) + 1;
  return std::binary_search(appeared_ids_.begin(), appeared_ids_.end(), object_id) ? slot_count()
                                                                                   : 0;
}

SceneMotion::LightMotion SceneMotion::light(std::uint32_t light_id) const {
  const auto it = light_tracks_.find(light_id);
  const Track track = it == light_tracks_.end() ? Track{} : it->second;
  LightMotion motion{track.now, track.before, track.now == track.before};
  motion.relative_from_light[3] -= glm::dvec4(view_.origin, 0);
  motion.previous_relative_from_light[3] -= glm::dvec4(previous_view_.origin, 0);
  return motion;
}

std::vector<std::uint32_t> SceneMotion::follow(std::map<std::uint32_t, Track>& tracks,
                                               const TransformTable& moved, bool first) {
  std::vector<std::uint32_t> appeared;
  for (auto& [id, track] : tracks) track.before = track.now;
  for (const auto& [id, matrix] : moved) {
    const auto [it, is_new] = tracks.try_emplace(id, Track{matrix, matrix});
    if (is_new) appeared.push_back(id);
    it->second.listed = frames_;
    if (is_new) continue;
    it->second.now = matrix;
    if (first) it->second.before = matrix;
  }
  return appeared;
}

ObjectMotion<float> SceneMotion::compose(const Track& track) const {
  ObjectMotion<float> motion;
  const glm::dmat4 inverse = glm::inverse(track.now);
  const double det = glm::determinant(glm::dmat3(track.now));
  const double det_before = glm::determinant(glm::dmat3(track.before));
  if (!std::isfinite(1.0 / det) || !std::isfinite(1.0 / det_before)) {
    motion.traceable = false;
    return motion;
  }
  const bool still = track.now == track.before;
  const glm::dmat4 world = still ? glm::dmat4(1.0) : track.before * inverse;
  glm::dmat4 carry{glm::dmat3(world)};
  carry[3] = glm::dvec4(glm::dvec3(world * glm::dvec4(view_.origin, 1)) - previous_view_.origin, 1);
  motion.carry = glm::mat4(carry);
  motion.rotate = glm::mat3(glm::inverseTranspose(glm::dmat3(world)));
  motion.prev_pixel = glm::mat4(previous_view_.pixel_from_relative * carry);
  const glm::dmat4 onwards = glm::inverse(carry);
  motion.next_pixel = glm::mat4(view_.pixel_from_relative * onwards);
  motion.at_rest = still && camera_at_rest_;
  return motion;
}

}  // namespace holdfast
