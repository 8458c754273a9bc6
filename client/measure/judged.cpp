#include "client/measure/judged.h"

#include <algorithm>
#include <cmath>

#include "core/frame/conventions.h"

namespace holdfast::measure {

Measure measure_of(PlaneKind kind) {
  return kind == PlaneKind::kVisibility ? Measure::kClip : Measure::kTonemap;
}

const char* measure_text(Measure measure) {
  return measure == Measure::kClip ? "values clipped to [0,1]" : "x/(1+x) of x = max(value,0)";
}

CleanImage clean_image(const Plane& plane) {
  CleanImage out{Image(plane.width(), plane.height(), plane.channels()), 0};
  for (int c = 0; c < plane.channels(); ++c) {
    float* target = out.image.channel(c);
    for (int y = 0; y < plane.height(); ++y) {
      const float* row = plane.channel(c).row(y);
      for (int x = 0; x < plane.width(); ++x) {
        const bool finite = std::isfinite(row[x]);
        *target++ = finite ? row[x] : 0.0f;
        out.non_finite += finite ? 0 : 1;
      }
    }
  }
  return out;
}

Image judged_image(const Image& clean, Measure measure) {
  Image out = clean;
  for (float& value : out.values) {
    const float positive = std::max(value, 0.0f);
    value = measure == Measure::kClip ? std::min(positive, 1.0f) : positive / (1.0f + positive);
  }
  return out;
}

Mask surface_mask(const Plane& depth) {
  Mask mask;
  mask.reserve(static_cast<std::size_t>(depth.width()) * static_cast<std::size_t>(depth.height()));
  for (int y = 0; y < depth.height(); ++y)
    for (int x = 0; x < depth.width(); ++x)
      mask.push_back(is_surface(depth.channel(0).at(x, y)) ? 1 : 0);
  return mask;
}

Mask effect_mask(const Image& reference, const Image& earlier_reference, const Mask& surface) {
  Mask mask(surface.size());
  for (std::size_t i = 0; i < mask.size(); ++i) {
    float change = 0;
    for (int c = 0; c < reference.channels; ++c)
      change =
          std::max(change, std::abs(reference.channel(c)[i] - earlier_reference.channel(c)[i]));
    mask[i] = surface[i] && change > kEffectThreshold ? 1 : 0;
  }
  return mask;
}

}  // namespace holdfast::measure
