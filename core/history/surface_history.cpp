#include "core/history/surface_history.h"

#include <algorithm>
#include <cmath>

#include "core/history/tap_search.h"
#include "core/kernels/parallel.h"

namespace holdfast {
namespace {

/// The taps and the motion of the pixels from (x, y) on that are `found`. `same`: both frames show
/// the same surface at a pixel.
void take(const FramePair& frames, const FollowedBlock& found, const std::uint8_t* same, int x,
          int y, int count, SurfaceHistory& out) {
  Taps taps[kFollowBlock];
  find_block_taps({frames.previous, found, frames.now.id[0].row(y) + x, count, taps});
  for (int i = 0; i < count; ++i) {
    if (found.found[i] == 0.0f) continue;
    const float motion_x = found.x[i] - (static_cast<float>(x + i) + 0.5f);
    const float motion_y = found.y[i] - (static_cast<float>(y) + 0.5f);
    out.taps[0].at(x + i, y) = motion_x == 0.0f && motion_y == 0.0f && same[i] != 0
                                   ? identity_taps(frames.previous, x + i, y)
                                   : taps[i];
    out.motion[0].at(x + i, y) = motion_x;
    out.motion[1].at(x + i, y) = motion_y;
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

/// Follows the row's pixels from x on that lie on `object`, whose `wanted` is cleared.
void follow_object(const FramePair& frames, const Plane* given_motion, int slot, const int* slots,
                   const BlockPixels& pixels, int x, int y, std::uint8_t* wanted,
                   FollowedBlock& followed) {
  const ObjectMotion<float>& object = frames.scene.object(slot);
  FollowedBlock found;
  if (object.traceable || given_motion != nullptr) {
    follow_surface({pixels, object, found});
    if (given_motion != nullptr)
      override_motion(*given_motion, x, y, pixels.count, found);
    else if (object.at_rest)
      stay(x, y, pixels.count, found);
  } else {
    std::fill_n(found.found, pixels.count, 0.0f);
  }
  for (int i = 0; i < pixels.count; ++i) {
    if (!wanted[i] || slots[i] != slot) continue;
    wanted[i] = 0;
    if (found.found[i] != 0.0f) copy_lane(found, i, followed, i);
  }
}

/// Pixels that stand still (`rigid`: no client's motion says otherwise) and show the same surface
/// as before keep their place; returns whether all of the block's surfaces do. `wanted` is set for
/// the others.
bool keep_still(const FramePair& frames, bool rigid, const int* slots, const std::uint8_t* same,
                int x, int y, int count, std::uint8_t* wanted, SurfaceHistory& out) {
  const float* depth = frames.now.depth().row(y) + x;
  const SceneMotion& scene = frames.scene;
  Taps* taps = out.taps[0].row(y) + x;
  const Taps first = identity_taps(frames.previous, x, y);
  const int last_column = frames.now.view.width - 1;
  int left = 0;
  for (int i = 0; i < count; ++i) {
    const bool surface = depth[i] > 0.0f;
    const bool still = rigid && same[i] != 0 && scene.object(slots[i]).at_rest;
    wanted[i] = surface && !still;
    left += wanted[i];
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

}  // namespace

void trace_surface_history(const FramePair& frames, const Plane* given_motion,
                           SurfaceHistory& out) {
  const Guides& now = frames.now;
  for_each_row(now.view.height, [&](int y) {
    SlotFinder slot(frames.scene);
    int slots[kFollowBlock] = {};
    std::uint8_t same[kFollowBlock] = {}, wanted[kFollowBlock];
    FollowedBlock followed{};
    for (int x = 0; x < now.view.width; x += kFollowBlock) {
      const BlockPixels pixels(now, x, y, std::min(kFollowBlock, now.view.width - x));
      for (int c = 0; c < 2; ++c) std::fill_n(out.motion[c].row(y) + x, pixels.count, 0.0f);
      const std::uint32_t* id = now.id[0].row(y) + x;
      if (frames.scene.slot_count() > 1)
        for (int i = 0; i < pixels.count; ++i) slots[i] = slot.of(id[i]);
      same_surface_block(now, frames.previous, x, y, pixels.count, same);
      if (keep_still(frames, given_motion == nullptr, slots, same, x, y, pixels.count, wanted, out))
        continue;
      std::fill_n(followed.found, pixels.count, 0.0f);
      for (int i = 0; i < pixels.count; ++i)
        if (wanted[i])
          follow_object(frames, given_motion, slots[i], slots, pixels, x, y, wanted, followed);
      take(frames, followed, same, x, y, pixels.count, out);
    }
  });
}

}  // namespace holdfast
