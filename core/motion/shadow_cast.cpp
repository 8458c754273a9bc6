#include "core/motion/shadow_cast.h"

#include <limits>

#include "core/kernels/variants.h"
#include "core/motion/plain_math.h"

namespace holdfast {
namespace {

/// A vector in the image, px.
struct Shift {
  float x, y;
};

/// Far enough for any image, and near enough for products of four to be finite.
HOLDFAST_INLINE float bounded_px(float v) { return min_of(max_of(v, -1e9f), 1e9f); }

HOLDFAST_INLINE float cross(const Shift& a, const Shift& b) { return a.x * b.y - a.y * b.x; }

/// How a half axis A of the light moves the shadow point: by tau (-A + (A.n) t / (t.n)), where
/// t = blocker - light and tau = receiver distance / |t|, both along the ray. The move is projected
/// by the derivative at the point: its end may well lie behind the camera.
HOLDFAST_INLINE Shift cast_axis(const Projection& pixel, const Float3& axis, const Float3& normal,
                                const Float3& slide, float tau, float px, float py, float per_w) {
  const float along = dot(axis, normal);
  const Float3 move{tau * (along * slide.x - axis.x), tau * (along * slide.y - axis.y),
                    tau * (along * slide.z - axis.z)};
  const float w = dot(pixel.w, move);
  return {bounded_px((dot(pixel.rows.x, move) - px * w) * per_w),
          bounded_px((dot(pixel.rows.y, move) - py * w) * per_w)};
}

template <int kAxes>
HOLDFAST_INLINE void cast_block(const ShadowCast& a) {
  const BlockPixels pixels = a.pixels;
  const Projection pixel = projection_of(a.pixel);
  const glm::mat3& h = a.half_axes;
  const Float3 axis_0{h[0].x, h[0].y, h[0].z}, axis_1{h[1].x, h[1].y, h[1].z};
  const Float3 axis_2{h[2].x, h[2].y, h[2].z};
  const float *depth = pixels.depth, *nx = pixels.normal[0], *ny = pixels.normal[1],
              *nz = pixels.normal[2], *distance = a.distance;
  const float *lx = a.light[0], *ly = a.light[1], *lz = a.light[2];
  const float light_w = a.light_w, py = a.pixel_y, deviation = __builtin_sqrtf(a.cast_variance);
  const float own = a.pixel_variance;
  float *out_valid = a.valid, *out_ratio = a.ratio;
  float *out_0 = a.precision[0], *out_1 = a.precision[1], *out_2 = a.precision[2];
#pragma GCC ivdep
  for (int i = 0; i < pixels.count; ++i) {
    const Float3 point = position(pixels, depth, i), normal{nx[i], ny[i], nz[i]};
    const Float3 to_light{lx[i] - light_w * point.x, ly[i] - light_w * point.y,
                          lz[i] - light_w * point.z};
    const float light_m = __builtin_sqrtf(dot(to_light, to_light));
    const float facing = dot(to_light, normal);
    // Blocked at a finite distance by a light in front: single comparisons of selects, since flow
    // of control would keep the loop scalar.
    const float usable = distance[i] <= std::numeric_limits<float>::max() ? distance[i] : -1.0f;
    const float above_m = usable >= 0.0f ? facing - 1e-4f * light_m : 0.0f;
    const bool valid = (depth[i] > 0.0f ? above_m : 0.0f) > 0.0f;
    const float ratio = usable / (valid ? light_m : 1.0f);
    const float beyond = max_of(1.0f - light_w * ratio, 1e-3f);  // blocker to light
    const float tau = ratio / beyond, inverse = 1.0f / (valid ? facing : 1.0f);
    const Float3 slide{to_light.x * inverse, to_light.y * inverse, to_light.z * inverse};
    const float px = pixels.first_x + static_cast<float>(i);
    const float w = dot(pixel.w, point) + pixel.w0;
    const float per_w = 1.0f / (w > 0.0f ? w : 1.0f);
    const float reach = deviation * tau;
    const Shift s0 = cast_axis(pixel, axis_0, normal, slide, reach, px, py, per_w);
    const Shift s1 = cast_axis(pixel, axis_1, normal, slide, reach, px, py, per_w);
    float xx = s0.x * s0.x + s1.x * s1.x, yy = s0.y * s0.y + s1.y * s1.y;
    float xy = s0.x * s0.y + s1.x * s1.y, areas = square(cross(s0, s1));
    if constexpr (kAxes > 2) {
      const Shift s2 = cast_axis(pixel, axis_2, normal, slide, reach, px, py, per_w);
      xx += s2.x * s2.x;
      yy += s2.y * s2.y;
      xy += s2.x * s2.y;
      areas += square(cross(s0, s2)) + square(cross(s1, s2));
    }
    // The determinant without its difference of near equals: shadows may be cast very long.
    const float determinant = own * own + own * (xx + yy) + areas;
    const float scale = 0.5f / max_of(determinant, own * own);
    out_valid[i] = valid ? 1.0f : 0.0f;
    out_ratio[i] = valid ? ratio : 0.0f;
    out_0[i] = valid ? (own + yy) * scale : 0.0f;
    out_1[i] = valid ? -xy * scale : 0.0f;
    out_2[i] = valid ? (own + xx) * scale : 0.0f;
  }
}

/// Whether the samples of a block are all unblocked: most of a frame is.
HOLDFAST_INLINE bool all_lit(const float* distance, int count) {
  int near = 0;
  for (int i = 0; i < count; ++i) near += distance[i] <= std::numeric_limits<float>::max() ? 1 : 0;
  return near == 0;
}

HOLDFAST_INLINE void fill_zero(float* out, int count) {
  for (int i = 0; i < count; ++i) out[i] = 0.0f;
}

HOLDFAST_INLINE void cast_kernel_body(const ShadowCast& a) {
  const int count = a.pixels.count;
  if (all_lit(a.distance, count)) {
    fill_zero(a.valid, count);
    fill_zero(a.ratio, count);
    for (int c = 0; c < 3; ++c) fill_zero(a.precision[c], count);
  } else if (a.axes > 2) {
    cast_block<3>(a);
  } else {
    cast_block<2>(a);
  }
}

HOLDFAST_KERNEL(cast_kernel, ShadowCast)

}  // namespace

void cast_shadows(const ShadowCast& block) noexcept { cast_kernel(block); }

}  // namespace holdfast
