#pragma once

#include <cstdint>

#include "client/measure/image.h"
#include "core/frame/plane.h"

namespace holdfast::measure {

/// How a layer's values are brought to [0,1] before they are judged.
enum class Measure {
  kClip,     ///< clamp(x, 0, 1); visibility
  kTonemap,  ///< max(x,0) / (1 + max(x,0)); radiance
};

Measure measure_of(PlaneKind kind);

/// "values clipped to [0,1]" or "x/(1+x) of x = max(value,0)", for reports.
const char* measure_text(Measure measure);

/// Values as they are, without what is not finite.
struct CleanImage {
  Image image;                  ///< a value that is not finite is 0
  std::int64_t non_finite = 0;  ///< number of such values, over the whole plane
};
CleanImage clean_image(const Plane& plane);

/// The values that errors are taken of, in [0,1].
Image judged_image(const Image& clean, Measure measure);

/// 1 where there is a surface, 0 in the sky. `depth` is the depth plane of the sequence's frame.
Mask surface_mask(const Plane& depth);

/// The least change of a reference that belongs to the effect mask.
inline constexpr float kEffectThreshold = 0.02f;

/// 1 where `surface` is 1 and the largest change over the channels exceeds kEffectThreshold. Both
/// images hold judged values.
Mask effect_mask(const Image& reference, const Image& earlier_reference, const Mask& surface);

}  // namespace holdfast::measure
