#include "core/history/surface_history.h"

#include <algorithm>
#include <cmath>

#include "core/history/motion_block.h"
#include "core/history/tap_search.h"
#include "core/kernels/parallel.h"

namespace holdfast {
namespace {

static_assert(kFollowBlock == SurfaceHistory::kBlock);

/// A block of a row on its way to the previous frame.
struct Lanes {
  int slot[kFollowBlock] = {};  ///< of the surfaces
  std::uint8_t same[kFollowBlock], wanted[kFollowBlock];
  FollowedBlock some, followed;
  float any[kFollowBlock];  ///< 1: there are taps
};

/// The motion of those that are `found`; returns whether any of them has not moved.
bool take_motion(const FollowedBlock& found, int x, int y, int count, SurfaceHistory& out) {
  std::int32_t any_stays = 0;
  write_motion({found.x, found.y, found.found, count, static_cast<float>(x) + 0.5f,
                static_cast<float>(y) + 0.5f, out.motion[0].row(y) + x, out.motion[1].row(y) + x,
                &any_stays});
  return any_stays != 0;
}

bool all_positive(const float* values, int count) {
  int all = 1;
  for (int i = 0; i < count; ++i) all &= values[i] > 0.0f ? 1 : 0;
  return all != 0;
}

/// The taps of those that are `found`, of others none. Where both frames show the same surface and
/// it has not moved they are the pixel itself.
void take_taps(const FramePair& frames, Lanes& lanes, bool any_stays, int x, int y, int count,
               Taps* taps, const SurfaceHistory& out) {
  const FollowedBlock& found = lanes.followed;
  find_block_taps(
      {frames.previous, found, frames.now.id[0].row(y) + x, count, taps, nullptr, lanes.any});
  if (!any_stays) return;
  std::uint8_t same[kFollowBlock];
  same_surface_block(frames.now, frames.previous, x, y, count, same);
  const float *motion_x = out.motion[0].row(y) + x, *motion_y = out.motion[1].row(y) + x;
  for (int i = 0; i < count; ++i)
    if (found.found[i] != 0.0f && motion_x[i] == 0.0f && motion_y[i] == 0.0f && same[i] != 0) {
      taps[i] = identity_taps(frames.previous, x + i, y);
      lanes.any[i] = 1.0f;
    }
}

/// Puts the client's motion in place of the rigid one.
void override_motion(const Plane& motion, int x, int y, int count, FollowedBlock& found) {
  const float *mx = motion.channel(0).row(y) + x, *my = motion.channel(1).row(y) + x;
  for (int i = 0; i < count; ++i) {
    const bool usable = std::isfinite(mx[i]) && std::isfinite(my[i]);
    found.x[i] = usable ? static_cast<float>(x + i) + 0.5f + mx[i] : 0.0f;
    found.y[i] = usable ? static_cast<float>(y) + 0.5f + my[i] : 0.0f;
    found.found[i] = usable ? 1.0f : 0.0f;
  }
}

/// Where pixels of one object at rest were: where they are.
void stay(int x, int y, int count, FollowedBlock& found) {
  for (int i = 0; i < count; ++i) {
    found.x[i] = static_cast<float>(x + i) + 0.5f;
    found.y[i] = static_cast<float>(y) + 0.5f;
    found.found[i] = 1.0f;
  }
}

/// Follows all pixels of a block as parts of one object.
void follow_object(const ObjectMotion<float>& object, const Plane* given_motion,
                   const BlockPixels& pixels, int x, int y, FollowedBlock& found) {
  if (!object.traceable && given_motion == nullptr) {
    std::fill_n(found.found, pixels.count, 0.0f);
    return;
  }
  follow_surface({pixels, object, found});
  if (given_motion != nullptr)
    override_motion(*given_motion, x, y, pixels.count, found);
  else if (object.at_rest)
    stay(x, y, pixels.count, found);
}

/// Follows a block of several objects, one after the other, and takes what is `wanted` of each.
void follow_objects(const FramePair& frames, const Plane* given_motion, const BlockPixels& pixels,
                    int x, int y, Lanes& lanes) {
  std::fill_n(lanes.followed.found, pixels.count, 0.0f);
  for (int first = 0; first < pixels.count; ++first) {
    if (!lanes.wanted[first]) continue;
    const int slot = lanes.slot[first];
    follow_object(frames.scene.object(slot), given_motion, pixels, x, y, lanes.some);
    for (int i = first; i < pixels.count; ++i) {
      if (!lanes.wanted[i] || lanes.slot[i] != slot) continue;
      lanes.wanted[i] = 0;
      if (lanes.some.found[i] != 0.0f) copy_lane(lanes.some, i, lanes.followed, i);
    }
  }
}

/// Pixels that stand still (`rigid`: no client's motion says otherwise) and show the same surface
/// as before keep their place; returns whether all of the block's surfaces do. `wanted` is set for
/// the others.
bool keep_still(const FramePair& frames, bool rigid, int x, int y, int count, Lanes& lanes,
                SurfaceHistory& out) {
  same_surface_block(frames.now, frames.previous, x, y, count, lanes.same);
  const float* depth = frames.now.depth().row(y) + x;
  const SceneMotion& scene = frames.scene;
  Taps* taps = out.taps[0].row(y) + x;
  const Taps first = identity_taps(frames.previous, x, y);
  const int last_column = frames.now.view.width - 1;
  int left = 0;
  for (int i = 0; i < count; ++i) {
    const bool surface = depth[i] > 0.0f;
    const bool still = rigid && lanes.same[i] != 0 && scene.object(lanes.slot[i]).at_rest;
    lanes.wanted[i] = surface && !still;
    left += lanes.wanted[i];
    if (!surface || !still) {
      taps[i] = Taps{};
    } else if (x + i < last_column) {
      taps[i] = first;
      taps[i].offset += i;
    } else {
      taps[i] = identity_taps(frames.previous, x + i, y);
    }
  }
  return left == 0;
}

/// Finds the objects of a block's pixels; returns whether they are one.
bool find_slots(const FramePair& frames, int x, int y, int count, SlotFinder& slot, Lanes& lanes) {
  if (frames.scene.slot_count() == 1) return true;
  return slot.of_all(frames.now.id[0].row(y) + x, count, lanes.slot);
}

/// A block of pixels that move with one object.
void trace_moving(const FramePair& frames, const Plane* given_motion, const BlockPixels& pixels,
                  int x, int y, Lanes& lanes, SurfaceHistory& out) {
  FollowedBlock& found = lanes.followed;
  follow_object(frames.scene.object(lanes.slot[0]), given_motion, pixels, x, y, found);
  for (int i = 0; i < pixels.count; ++i)
    found.found[i] = pixels.depth[i] > 0.0f ? found.found[i] : 0.0f;
  const bool any_stays = take_motion(found, x, y, pixels.count, out);
  take_taps(frames, lanes, any_stays, x, y, pixels.count, out.taps[0].row(y) + x, out);
  out.complete[0].at(x / SurfaceHistory::kBlock, y) = all_positive(lanes.any, pixels.count);
}

/// Any other block.
void trace_several(const FramePair& frames, const Plane* given_motion, const BlockPixels& pixels,
                   int x, int y, Lanes& lanes, SurfaceHistory& out) {
  const bool all_still =
      keep_still(frames, given_motion == nullptr, x, y, pixels.count, lanes, out);
  Taps* taps = out.taps[0].row(y) + x;
  if (all_still) {
    for (int c = 0; c < 2; ++c) std::fill_n(out.motion[c].row(y) + x, pixels.count, 0.0f);
  } else {
    follow_objects(frames, given_motion, pixels, x, y, lanes);
    const bool any_stays = take_motion(lanes.followed, x, y, pixels.count, out);
    Taps found[kFollowBlock];
    take_taps(frames, lanes, any_stays, x, y, pixels.count, found, out);
    for (int i = 0; i < pixels.count; ++i)
      if (lanes.followed.found[i] != 0.0f) taps[i] = found[i];
  }
  out.complete[0].at(x / SurfaceHistory::kBlock, y) =
      std::all_of(taps, taps + pixels.count, [](const Taps& each) { return each.any(); });
}

}  // namespace

void trace_surface_history(const FramePair& frames, const Plane* given_motion,
                           SurfaceHistory& out) {
  const Guides& now = frames.now;
  for_each_row(now.view.height, [&](int y) {
    SlotFinder slot(frames.scene);
    Lanes lanes;
    for (int x = 0; x < now.view.width; x += kFollowBlock) {
      const BlockPixels pixels(now, x, y, std::min(kFollowBlock, now.view.width - x));
      const bool one = find_slots(frames, x, y, pixels.count, slot, lanes);
      if (one && (given_motion != nullptr || !frames.scene.object(lanes.slot[0]).at_rest))
        trace_moving(frames, given_motion, pixels, x, y, lanes, out);
      else
        trace_several(frames, given_motion, pixels, x, y, lanes, out);
    }
  });
}

}  // namespace holdfast
