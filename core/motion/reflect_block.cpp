#include "core/motion/reflect_block.h"

#include <limits>

#include "core/kernels/random.h"
#include "core/kernels/variants.h"
#include "core/motion/lobe_spread.h"

namespace holdfast {
namespace {

/// A point (w = 1) or a direction (w = 0).
struct Homogeneous {
  Float3 v;
  float w;
};

HOLDFAST_INLINE float length_of(const Float3& v) { return __builtin_sqrtf(dot(v, v)); }

/// `virtual_image` of glossy_motion.h.
HOLDFAST_INLINE Homogeneous image_of(const Homogeneous& hit, const Float3& surface,
                                     const Float3& normal) {
  const Float3 from{hit.v.x - hit.w * surface.x, hit.v.y - hit.w * surface.y,
                    hit.v.z - hit.w * surface.z};
  const float twice = 2.0f * dot(from, normal);
  return {{hit.v.x - twice * normal.x, hit.v.y - twice * normal.y, hit.v.z - twice * normal.z},
          hit.w};
}

template <bool kRelative>
HOLDFAST_INLINE void follow_images(const ReflectionFollow& a) {
  const BlockPixels pixels = a.pixels;
  const Affine carry = affine_of(a.surface.carry), rotate = affine_of(glm::mat4(a.surface.rotate));
  const Affine carry_hit = affine_of(a.hit.carry);
  const Projection then = projection_of(a.previous_pixel), now = projection_of(a.pixel);
  const float *depth = pixels.depth, *nx = pixels.normal[0], *ny = pixels.normal[1],
              *nz = pixels.normal[2];
  const float *dx = a.direction[0], *dy = a.direction[1], *dz = a.direction[2], *hit_m = a.hit_m;
  constexpr float kMost = std::numeric_limits<float>::max();
  FollowedBlock& out = a.out;
  float *now_x = a.now_x, *now_y = a.now_y;
#pragma GCC ivdep
  for (int i = 0; i < pixels.count; ++i) {
    const Float3 point = position(pixels, depth, i), normal{nx[i], ny[i], nz[i]};
    const Float3 receiver = carried(carry, point), turned = rotated(rotate, normal);
    store(out.point, i, receiver);
    store(out.normal, i, turned);
    const float length = length_of({dx[i], dy[i], dz[i]});
    const float usable = (length > 0.0f ? 1.0f : 0.0f) * (length <= kMost ? 1.0f : 0.0f) *
                         (hit_m[i] >= 0.0f ? 1.0f : 0.0f) * (depth[i] > 0.0f ? 1.0f : 0.0f);
    const float w = hit_m[i] <= kMost ? 1.0f : 0.0f;
    const float far = (hit_m[i] <= kMost ? hit_m[i] : 1.0f) / (length > 0.0f ? length : 1.0f);
    const Homogeneous hit{
        {w * point.x + far * dx[i], w * point.y + far * dy[i], w * point.z + far * dz[i]}, w};
    const Float3 moved = carried(carry_hit, hit.v);
    const Homogeneous hit_then{
        {w > 0.0f ? moved.x : hit.v.x, w > 0.0f ? moved.y : hit.v.y, w > 0.0f ? moved.z : hit.v.z},
        w};
    float found_then, found_now = 1.0f;
    const Homogeneous image_then = image_of(hit_then, receiver, turned);
    project_to(then, image_then.v, w, usable > 0.0f, out.x[i], out.y[i], found_then);
    if constexpr (kRelative) {
      const Homogeneous image = image_of(hit, point, normal);
      project_to(now, image.v, w, usable > 0.0f, now_x[i], now_y[i], found_now);
    }
    out.found[i] = found_then * found_now;
  }
}

HOLDFAST_INLINE void images_body(const ReflectionFollow& a) {
  a.now_x != nullptr ? follow_images<true>(a) : follow_images<false>(a);
}

HOLDFAST_INLINE void spread_body(const ReflectionSpread& a) {
  const Projection then = projection_of(a.previous_pixel);
  const float *px = a.from.point[0], *py = a.from.point[1], *pz = a.from.point[2];
  const float *nx = a.from.normal[0], *ny = a.from.normal[1], *nz = a.from.normal[2];
  const float *image_x = a.from.x, *image_y = a.from.y, *hit_m = a.hit_m, *u = a.u, *v = a.v;
  const float* roughness = a.roughness;
  float *x = a.x, *y = a.y;
  const float focal_px = a.focal_px;
#pragma GCC ivdep
  for (int i = 0; i < a.count; ++i) {
    const Float3 p{px[i], py[i], pz[i]}, n{nx[i], ny[i], nz[i]};
    const LobeSpread lobe = lobe_spread(then, focal_px, p, n, hit_m[i], roughness[i]);
    // Box-Muller: angles are folded into a quarter of a turn.
    const float radius = __builtin_sqrtf(-2.0f * log_of(u[i]));
    const float turn = v[i] - 0.5f, folded = 0.25f - abs_of(abs_of(turn) - 0.25f);
    const float sine = -sine_of_quarter(turn < 0.0f ? -folded : folded);
    const float cosine = -sine_of_quarter(0.25f - abs_of(turn));
    const float in = radius * cosine * lobe.in_plane, out = radius * sine * lobe.out_of_plane;
    x[i] = image_x[i] + (in * lobe.along_x - out * lobe.along_y);
    y[i] = image_y[i] + (in * lobe.along_y + out * lobe.along_x);
  }
}

HOLDFAST_INLINE void pairs_body(const PairDraws& a) {
  const std::uint64_t key = a.key, first = a.first;
  float *u = a.u, *v = a.v;
#pragma GCC ivdep
  for (int i = 0; i < a.count; ++i) {
    const UniformPair pair = uniform_pair(key ^ mix_bits(first + static_cast<std::uint64_t>(i)));
    u[i] = pair.u;
    v[i] = pair.v;
  }
}

HOLDFAST_KERNEL(images, ReflectionFollow)
HOLDFAST_KERNEL(spread, ReflectionSpread)
HOLDFAST_KERNEL(pairs, PairDraws)

}  // namespace

void follow_reflection(const ReflectionFollow& block) noexcept { images(block); }
void spread_reflection(const ReflectionSpread& block) noexcept { spread(block); }
void draw_pairs(const PairDraws& block) noexcept { pairs(block); }

}  // namespace holdfast
