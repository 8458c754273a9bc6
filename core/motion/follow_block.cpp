#include "core/motion/follow_block.h"

#include "core/kernels/variants.h"
#include "core/motion/plain_math.h"

namespace holdfast {
namespace {

/// The vector whose product with a displacement counts it in widths of the half axis.
HOLDFAST_INLINE Float3 per_width(const glm::vec3& half_axis) {
  const float x = half_axis.x, y = half_axis.y, z = half_axis.z;
  const float square_m = x * x + y * y + z * z;
  const float scale = square_m > 0.0f ? 0.5f / square_m : 0.0f;
  return {scale * x, scale * y, scale * z};
}

HOLDFAST_INLINE void surface_kernel_body(const SurfaceFollow& a) {
  const BlockPixels pixels = a.pixels;
  const Affine carry = affine_of(a.object.carry), rotate = affine_of(glm::mat4(a.object.rotate));
  const Projection projection = projection_of(a.object.prev_pixel);
  const float *depth = pixels.depth, *nx = pixels.normal[0], *ny = pixels.normal[1],
              *nz = pixels.normal[2];
  FollowedBlock& out = a.out;
#pragma GCC ivdep
  for (int i = 0; i < pixels.count; ++i) {
    const Float3 point = position(pixels, depth, i);
    store(out.point, i, carried(carry, point));
    store(out.normal, i, rotated(rotate, {nx[i], ny[i], nz[i]}));
    project_to(projection, point, true, out.x[i], out.y[i], out.found[i]);
  }
}

HOLDFAST_INLINE void shadow_kernel_body(const ShadowFollow& a) {
  const BlockPixels pixels = a.pixels;
  const Affine carry = affine_of(a.surface.carry), rotate = affine_of(glm::mat4(a.surface.rotate));
  const Affine carry_blocker = affine_of(a.occluder.carry);
  const Projection projection = projection_of(a.previous_pixel);
  const float *depth = pixels.depth, *nx = pixels.normal[0], *ny = pixels.normal[1],
              *nz = pixels.normal[2];
  const float* ratio = a.ratio;
  const float *lx = a.light[0], *ly = a.light[1], *lz = a.light[2], w = a.light_w;
  const float *mx = a.previous_light[0], *my = a.previous_light[1], *mz = a.previous_light[2];
  const Float3 across_0 = per_width(a.previous_half_axes[0]),
               across_1 = per_width(a.previous_half_axes[1]),
               across_2 = per_width(a.previous_half_axes[2]);
  FollowedBlock& out = a.out;
#pragma GCC ivdep
  for (int i = 0; i < pixels.count; ++i) {
    const Float3 point = position(pixels, depth, i);
    const Float3 blocker_now{point.x + ratio[i] * (lx[i] - w * point.x),
                             point.y + ratio[i] * (ly[i] - w * point.y),
                             point.z + ratio[i] * (lz[i] - w * point.z)};
    const Float3 surface = carried(carry, point);
    const Float3 normal = rotated(rotate, {nx[i], ny[i], nz[i]});
    const Float3 blocker = carried(carry_blocker, blocker_now);
    store(out.point, i, surface);
    store(out.normal, i, normal);
    // `shadow_sweep`, then `shadow_previous_point` of shadow_motion.h.
    const float stretch = 1.0f / max_of(ratio[i], 1e-6f);
    const Float3 moved{stretch * (blocker.x - surface.x) + w * surface.x - mx[i],
                       stretch * (blocker.y - surface.y) + w * surface.y - my[i],
                       stretch * (blocker.z - surface.z) + w * surface.z - mz[i]};
    out.sweep[i] = __builtin_sqrtf(square(dot(moved, across_0)) + square(dot(moved, across_1)) +
                                   square(dot(moved, across_2)));
    const Float3 towards{w * blocker.x - mx[i], w * blocker.y - my[i], w * blocker.z - mz[i]};
    const float descent = dot(towards, normal);
    const bool falls = descent < -1e-4f * __builtin_sqrtf(dot(towards, towards));
    const Float3 line{surface.x - blocker.x, surface.y - blocker.y, surface.z - blocker.z};
    const float tau = dot(line, normal) / (falls ? descent : -1.0f);
    const bool valid = falls && tau >= -1e-4f && tau < 1e6f;
    const Float3 hit{blocker.x + tau * towards.x, blocker.y + tau * towards.y,
                     blocker.z + tau * towards.z};
    project_to(projection, hit, valid, out.x[i], out.y[i], out.found[i]);
  }
}

HOLDFAST_KERNEL(surface_kernel, SurfaceFollow)
HOLDFAST_KERNEL(shadow_kernel, ShadowFollow)

}  // namespace

BlockPixels::BlockPixels(const Guides& guides, int x, int y, int pixels)
    : depth(guides.depth().row(y) + x),
      first_x(static_cast<float>(x) + 0.5f),
      count(pixels),
      near_weight(guides.rays.near_weight),
      far_weight(guides.rays.far_weight) {
  const PixelRays<float>& rays = guides.rays;
  const glm::vec3 start = rays.lateral_0 + (static_cast<float>(y) + 0.5f) * rays.lateral_y;
  for (int axis = 0; axis < 3; ++axis) {
    normal[axis] = guides.normal(axis).row(y) + x;
    base[axis] = start[axis];
    across[axis] = rays.lateral_x[axis];
    forward[axis] = rays.forward[axis];
  }
}

void follow_surface(const SurfaceFollow& block) noexcept { surface_kernel(block); }
void follow_shadow(const ShadowFollow& block) noexcept { shadow_kernel(block); }

}  // namespace holdfast
