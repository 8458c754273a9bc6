#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <vector>

#include "core/frame/frame.h"
#include "core/frame/view_geometry.h"

namespace holdfast {

/// How one rigid object moved, between camera-relative points of the current and of the previous
/// frame. Matrices are composed in double; `T` is the type they are applied in.
template <class T>
struct ObjectMotion {
  glm::mat<3, 3, T> rotate{1};      ///< previous normal = rotate * current normal, then normalise
  glm::mat<4, 4, T> carry{1};       ///< previous relative point from current relative point
  glm::mat<4, 4, T> prev_pixel{1};  ///< (x w, y w, depth, w) of the previous frame from the
                                    ///< current relative point
  glm::mat<4, 4, T> next_pixel{1};  ///< (x w, y w, depth, w) of the current frame from the
                                    ///< previous relative point
  bool at_rest = false;             ///< object and camera both stand still: motion is exactly 0
  bool appeared = false;  ///< placed for the first time: nobody knows whether it was there
  bool traceable = true;  ///< false for a singular transform: nothing corresponds
};

/// Follows cameras, objects and lights from frame to frame and answers where a point was before.
/// A frame's tables list only what moved; this class remembers the rest, up to kMostObjects:
/// beyond that it forgets the objects that were listed longest ago. One that is listed again after
/// that counts as new.
class SceneMotion {
 public:
  /// Takes the next frame's camera and tables. Throws InputError (state unchanged) for a matrix
  /// that is not finite, a singular camera, or a light id that `known_lights` lacks.
  void advance(const Frame& frame, int width, int height, const std::vector<Light>& known_lights);

  /// Becomes `full` in pixels of twice the size (ViewGeometry::halved), for this frame: it is not
  /// to be advanced.
  void follow_halved(const SceneMotion& full);

  /// The last frame counts as one of that size, by the same camera.
  void resize(int width, int height);

  static constexpr std::size_t kMostObjects = std::size_t{1} << 16;
  std::size_t remembered_objects() const { return object_tracks_.size(); }

  /// Forgets the past: the next frame counts as the first.
  void reset();

  const ViewGeometry& view() const { return view_; }
  const ViewGeometry& previous_view() const { return previous_view_; }

  /// Motion of the slot that `slot_of` names; slot 0 is the static world. What has appeared shares
  /// a slot behind the last of `slot_count`.
  const ObjectMotion<float>& object(int slot) const {
    return objects_[static_cast<std::size_t>(slot)];
  }
  int slot_of(std::uint32_t object_id) const;
  /// The object of a slot, which is not slot 0.
  std::uint32_t id_of(int slot) const { return slot_ids_[static_cast<std::size_t>(slot - 1)]; }
  int slot_count() const { return static_cast<int>(slot_ids_.size()) + 1; }
  /// Whether objects have been placed for the first time in this frame, which is not the first.
  bool objects_appeared() const { return !appeared_ids_.empty(); }
  /// True when camera and all objects stand still.
  bool geometry_at_rest() const { return geometry_at_rest_; }
  /// True when the lights stand still, too, and nothing has been placed for the first time.
  bool at_rest() const;

  /// Camera-relative world_from_light now and one frame ago. Identity at the world's origin if no
  /// frame has placed the light.
  struct LightMotion {
    glm::dmat4 relative_from_light{1}, previous_relative_from_light{1};
    bool at_rest = true;  ///< in the world
  };
  LightMotion light(std::uint32_t light_id) const;

 private:
  struct Track {
    glm::dmat4 now{1}, before{1};
    std::uint64_t listed = 0;  ///< frame that listed it last, counted by `frames_`
  };
  void forget_oldest();
  /// Returns what was placed for the first time, sorted.
  std::vector<std::uint32_t> follow(std::map<std::uint32_t, Track>& tracks,
                                    const TransformTable& moved, bool first);
  ObjectMotion<float> compose(const Track& track) const;

  std::map<std::uint32_t, Track> object_tracks_, light_tracks_;
  ViewGeometry view_, previous_view_;
  glm::dmat4 view_matrix_{1}, clip_matrix_{1};
  std::uint64_t frames_ = 0;
  bool camera_at_rest_ = false, geometry_at_rest_ = false, has_past_ = false, appeared_ = false;
  std::vector<std::uint32_t> slot_ids_;      ///< sorted; slot k + 1 belongs to slot_ids_[k]
  std::vector<std::uint32_t> appeared_ids_;  ///< sorted: objects
  std::vector<ObjectMotion<float>> objects_;
};

/// `slot_of` for pixels in a row, most of which show the object of the one before.
class SlotFinder {
 public:
  explicit SlotFinder(const SceneMotion& scene) : scene_(scene), slot_(scene.slot_of(id_)) {}
  int of(std::uint32_t object_id) {
    if (object_id != id_) slot_ = scene_.slot_of(id_ = object_id);
    return slot_;
  }
  /// Finds the slots of several; returns whether they are one.
  bool of_all(const std::uint32_t* ids, int count, int* slots) {
    std::uint32_t differing = 0;
    for (int i = 1; i < count; ++i) differing |= ids[i] ^ ids[0];
    if (differing == 0) {
      std::fill_n(slots, count, of(ids[0]));
      return true;
    }
    for (int i = 0; i < count; ++i) slots[i] = of(ids[i]);
    return std::all_of(slots, slots + count, [&](int s) { return s == slots[0]; });
  }

 private:
  const SceneMotion& scene_;
  std::uint32_t id_ = 0;
  int slot_;
};

}  // namespace holdfast
