#include "core/history/surface_history.h"

#include <algorithm>
#include <cmath>

#include "core/kernels/parallel.h"
#include "core/motion/follow_block.h"

namespace holdfast {
namespace {

/// The taps of a pixel whose receiver was at lane i of `found`, and its motion. `same`: both frames
/// show the same surface at (x, y).
void take(const FramePair& frames, const FollowedBlock& found, int i, bool same, int x, int y,
          SurfaceHistory& out) {
  if (found.found[i] == 0.0f) return;
  const Receiver receiver{{found.point[0][i], found.point[1][i], found.point[2][i]},
                          {found.normal[0][i], found.normal[1][i], found.normal[2][i]},
                          frames.now.id[0].at(x, y)};
  const float motion_x = found.x[i] - (static_cast<float>(x) + 0.5f);
  const float motion_y = found.y[i] - (static_cast<float>(y) + 0.5f);
  out.taps[0].at(x, y) = motion_x == 0.0f && motion_y == 0.0f && same
                             ? identity_taps(frames.previous, x, y)
                             : find_taps(frames.previous, found.x[i], found.y[i], receiver);
  out.motion[0].at(x, y) = motion_x;
  out.motion[1].at(x, y) = motion_y;
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

/// The row's pixels from x on that lie on `object`, whose `wanted` is cleared.
void trace_block(const FramePair& frames, const Plane* given_motion, int slot, const int* slots,
                 const std::uint8_t* same, const BlockPixels& pixels, int x, int y,
                 std::uint8_t* wanted, SurfaceHistory& out) {
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
    take(frames, found, i, same[i] != 0, x + i, y, out);
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
    int slots[kFollowBlock] = {};
    std::uint8_t same[kFollowBlock] = {}, wanted[kFollowBlock];
    for (int x = 0; x < now.view.width; x += kFollowBlock) {
      const BlockPixels pixels(now, x, y, std::min(kFollowBlock, now.view.width - x));
      for (int c = 0; c < 2; ++c) std::fill_n(out.motion[c].row(y) + x, pixels.count, 0.0f);
      if (frames.scene.slot_count() > 1)
        for (int i = 0; i < pixels.count; ++i)
          slots[i] = frames.scene.slot_of(now.id[0].at(x + i, y));
      same_surface_block(now, frames.previous, x, y, pixels.count, same);
      if (keep_still(frames, given_motion == nullptr, slots, same, x, y, pixels.count, wanted, out))
        continue;
      for (int i = 0; i < pixels.count; ++i)
        if (wanted[i])
          trace_block(frames, given_motion, slots[i], slots, same, pixels, x, y, wanted, out);
    }
  });
}

}  // namespace holdfast
