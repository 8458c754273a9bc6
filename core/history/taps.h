#pragma once

#include <cstdint>
#include <cstring>
#include <type_traits>

#include "core/frame/guides.h"

namespace holdfast {

/// Bilinear history taps of one pixel: four weights at `offset + {0, dx, dy, dx + dy}` of any
/// channel of the session's size. The weights sum to 1, or to 0 where there is no history.
struct Taps {
  std::int32_t offset = 0;
  float weight[4] = {0, 0, 0, 0};

  bool any() const { return weight[0] + weight[1] + weight[2] + weight[3] > 0.0f; }
};

inline void clear(Taps* taps, int count) {
  static_assert(std::is_trivially_copyable_v<Taps>);  // and all zeros
  std::memset(static_cast<void*>(taps), 0, sizeof(Taps) * static_cast<std::size_t>(count));
}

/// What a history pixel must show to count as the same receiver one frame ago.
struct Receiver {
  glm::vec3 point;   ///< relative to the previous camera, metres
  glm::vec3 normal;  ///< unit, previous frame
  std::uint32_t id;
};

/// Rules of tap validity.
inline constexpr float kTapPlaneTolerancePx = 2.0f;    // footprints off the receiver's plane; ours
inline constexpr float kTapNormalCosine = 0.9f;        // 26 degrees; ours
inline constexpr float kTapRoughnessTolerance = 0.1f;  // perceptual, where it matters; ours
inline constexpr float kLeastTapWeight = 1e-3f;        // of one tap, below which it is left out
inline constexpr float kLeastTapSum = 0.01f;  // of the valid taps, below which they are lost

/// How far off the receiver's plane a pixel at depth 1 m (of an orthographic view, at any) may be,
/// metres.
inline float tap_tolerance(const Guides& previous) {
  return kTapPlaneTolerancePx * static_cast<float>(previous.view.pixel_angle);
}

/// Finds taps around previous pixel position (x, y): the 2x2 bilinear neighbourhood, each tap
/// tested on its own (inside the image, same id, on the receiver's plane, similar normal) and
/// renormalised; else the nearest valid tap of the 3x3 neighbourhood; else none.
Taps find_taps(const Guides& previous, float x, float y, const Receiver& receiver);

/// As find_taps for what stands in for a receiver: any id counts, but `foreign_id` only if it is
/// the receiver's own.
Taps find_similar_taps(const Guides& previous, float x, float y, const Receiver& receiver,
                       std::uint32_t foreign_id);

/// True where both frames show exactly the same surface at pixel (x, y).
bool same_surface(const Guides& now, const Guides& previous, int x, int y);

/// The same for `count` pixels from (x, y) on: same[i] = 1 or 0.
void same_surface_block(const Guides& now, const Guides& previous, int x, int y, int count,
                        std::uint8_t* same);

/// As find_taps, where any surface inside the image is valid.
Taps find_taps_on_any_surface(const Guides& previous, float x, float y);

/// The last resort of both: the nearest valid pixel of the 3x3 neighbourhood of (x, y), or none.
Taps rescue_taps(const Guides& previous, float x, float y, const Receiver& receiver);
Taps rescue_taps_on_any_surface(const Guides& previous, float x, float y);

/// Taps at pixel (x, y) itself, weight 1.
Taps identity_taps(const Guides& previous, int x, int y);

/// The taps of `first`, where there are none those of `second`; written to `own` only if the block
/// has both kinds.
inline const Taps* preferred_taps(const Taps* first, const Taps* second, int count, Taps* own) {
  bool mixed = false;
  for (int i = 0; i < count; ++i) mixed |= !first[i].any() && second[i].any();
  if (!mixed) return first;
  for (int i = 0; i < count; ++i) own[i] = first[i].any() ? first[i] : second[i];
  return own;
}

/// The weighted value of a channel at `taps`.
inline float gather(ChannelView<const float> channel, const Taps& taps) {
  const int dx = channel.width > 1 ? 1 : 0;
  const std::ptrdiff_t dy = channel.height > 1 ? channel.stride : 0;
  const float* p = channel.data + taps.offset;
  return taps.weight[0] * p[0] + taps.weight[1] * p[dx] + taps.weight[2] * p[dy] +
         taps.weight[3] * p[dy + dx];
}

}  // namespace holdfast
