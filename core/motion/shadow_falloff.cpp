#include "core/motion/shadow_falloff.h"

#include "core/kernels/variants.h"
#include "core/motion/plain_math.h"
#include "core/motion/shadow_motion.h"

namespace holdfast {
namespace {

/// The pixels that are looked at: the ones that positions lie in.
struct Seen {
  std::int32_t at[kFollowBlock];  ///< in a channel
  float x[kFollowBlock], y[kFollowBlock], depth[kFollowBlock];
};

HOLDFAST_INLINE void look(const ShadowFalloff& a, Seen& seen) {
  const ChannelView<const float> depth = a.previous.depth();
  const auto right = static_cast<float>(depth.width - 1);
  const auto bottom = static_cast<float>(depth.height - 1);
  const auto stride = static_cast<std::int32_t>(depth.stride);
  const float *px = a.followed.x, *py = a.followed.y, *found = a.followed.found;
  float inside[kFollowBlock];
#pragma GCC ivdep
  for (int i = 0; i < a.count; ++i) {
    const float x = min_of(max_of(px[i], 0.0f), right), y = min_of(max_of(py[i], 0.0f), bottom);
    const int ix = static_cast<int>(x), iy = static_cast<int>(y);
    seen.at[i] = iy * stride + ix;
    seen.x[i] = static_cast<float>(ix) + 0.5f;
    seen.y[i] = static_cast<float>(iy) + 0.5f;
    const float x_inside = (px[i] >= 0.0f ? 1.0f : 0.0f) * (px[i] < right + 1.0f ? 1.0f : 0.0f);
    const float y_inside = (py[i] >= 0.0f ? 1.0f : 0.0f) * (py[i] < bottom + 1.0f ? 1.0f : 0.0f);
    inside[i] = (found[i] > 0.0f ? 1.0f : 0.0f) * x_inside * y_inside;
  }
  for (int i = 0; i < a.count; ++i) seen.depth[i] = inside[i] * depth.data[seen.at[i]];
}

/// asin(x) for |x| <= 1/2, error below 2e-6; above that it is too small, but at least x, where the
/// falloff has come to nothing.
HOLDFAST_INLINE float asin_of(float x) {
  const float x2 = x * x;
  return x * (1.0f +
              x2 * (1.0f / 6.0f +
                    x2 * (3.0f / 40.0f + x2 * (15.0f / 336.0f + x2 * (105.0f / 3456.0f +
                                                                      x2 * (945.0f / 42240.0f))))));
}

HOLDFAST_INLINE void falloff_body(const ShadowFalloff& a) {
  Seen seen;
  look(a, seen);
  const PixelRays<float>& rays = a.previous.rays;
  const Float3 l0{rays.lateral_0.x, rays.lateral_0.y, rays.lateral_0.z};
  const Float3 lx{rays.lateral_x.x, rays.lateral_x.y, rays.lateral_x.z};
  const Float3 ly{rays.lateral_y.x, rays.lateral_y.y, rays.lateral_y.z};
  const Float3 forward{rays.forward.x, rays.forward.y, rays.forward.z};
  const float near_w = rays.near_weight, far_w = rays.far_weight;
  const auto angle_px = static_cast<float>(a.previous.view.pixel_angle);
  const FollowedBlock& f = a.followed;
  float* trust = a.trust;
#pragma GCC ivdep
  for (int i = 0; i < a.count; ++i) {
    const Float3 n{f.normal[0][i], f.normal[1][i], f.normal[2][i]};
    const float x = f.x[i], y = f.y[i], d = seen.depth[i];
    // The receiver's plane along the ray of (x, y): X(d) is affine in d.
    const Float3 lateral{l0.x + x * lx.x + y * ly.x, l0.y + x * lx.y + y * ly.y,
                         l0.z + x * lx.z + y * ly.z};
    const Float3 ray{far_w * lateral.x + forward.x, far_w * lateral.y + forward.y,
                     far_w * lateral.z + forward.z};
    const Float3 from_start{f.point[0][i] - near_w * lateral.x, f.point[1][i] - near_w * lateral.y,
                            f.point[2][i] - near_w * lateral.z};
    const float facing = dot(ray, n);
    const float usable = abs_of(facing) > 1e-6f ? facing : 1.0f;
    const float depth = dot(from_start, n) / usable;
    const float footprint = angle_px * (near_w + far_w * depth);
    const float sx = seen.x[i], sy = seen.y[i], scale = near_w + far_w * d;
    const Float3 line{
        scale * (l0.x + sx * lx.x + sy * ly.x) + d * forward.x - near_w * lateral.x - depth * ray.x,
        scale * (l0.y + sx * lx.y + sy * ly.y) + d * forward.y - near_w * lateral.y - depth * ray.y,
        scale * (l0.z + sx * lx.z + sy * ly.z) + d * forward.z - near_w * lateral.z -
            depth * ray.z};
    const float distance = __builtin_sqrtf(dot(line, line));
    const float sine = min_of(abs_of(dot(line, n)) / max_of(distance, 1e-30f), 1.0f);
    const float angle = asin_of(sine);
    const float gauss = exp_nonpositive(angle * angle * (-0.5f / (kFalloffSigma * kFalloffSigma)));
    const float near = distance <= footprint ? 1.0f : gauss;
    const float faces = abs_of(facing) > 1e-6f ? near : 0.0f;
    trust[i] = d > 0.0f ? faces : 0.0f;
  }
}

HOLDFAST_KERNEL(falloff, ShadowFalloff)

}  // namespace

void shadow_falloff(const ShadowFalloff& block) noexcept { falloff(block); }

}  // namespace holdfast
