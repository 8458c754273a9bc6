#pragma once

#include <limits>

#include "core/kernels/math.h"
#include "core/motion/follow_block.h"

/// Vectors and matrices as plain numbers, for the kernels of this folder.
namespace holdfast {

/// Three floats; GLM's own functions are not inlined into every variant of a kernel.
struct Float3 {
  float x, y, z;
};

HOLDFAST_INLINE float dot(const Float3& a, const Float3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

/// Rows of a matrix, as plain numbers that a loop keeps in registers.
struct Affine {
  Float3 x, y, z;
  float x0, y0, z0;
};

HOLDFAST_INLINE Affine affine_of(const glm::mat4& m) {
  return {{m[0].x, m[1].x, m[2].x},
          {m[0].y, m[1].y, m[2].y},
          {m[0].z, m[1].z, m[2].z},
          m[3].x,
          m[3].y,
          m[3].z};
}

HOLDFAST_INLINE Float3 carried(const Affine& m, const Float3& p) {
  return {dot(m.x, p) + m.x0, dot(m.y, p) + m.y0, dot(m.z, p) + m.z0};
}

/// A normal turned by `rotate` of ObjectMotion.
HOLDFAST_INLINE Float3 rotated(const Affine& m, const Float3& n) {
  const Float3 r{dot(m.x, n), dot(m.y, n), dot(m.z, n)};
  const float inverse = 1.0f / __builtin_sqrtf(dot(r, r));
  return {r.x * inverse, r.y * inverse, r.z * inverse};
}

/// Writes lane i.
HOLDFAST_INLINE void store(float (*to)[kFollowBlock], int i, const Float3& v) {
  to[0][i] = v.x;
  to[1][i] = v.y;
  to[2][i] = v.z;
}

struct Projection {
  Affine rows;  ///< x w, y w, depth
  Float3 w;
  float w0;
};

HOLDFAST_INLINE Projection projection_of(const glm::mat4& m) {
  return {affine_of(m), {m[0].w, m[1].w, m[2].w}, m[3].w};
}

/// `project` of view_geometry.h, for a point (w = 1) or a direction (w = 0).
HOLDFAST_INLINE void project_to(const Projection& m, const Float3& point, float point_w, bool valid,
                                float& x, float& y, float& found) {
  const Float3 h{dot(m.rows.x, point) + point_w * m.rows.x0,
                 dot(m.rows.y, point) + point_w * m.rows.y0,
                 dot(m.rows.z, point) + point_w * m.rows.z0};
  const float w = dot(m.w, point) + point_w * m.w0;
  const float front = valid ? min_of(w, h.z) : 0.0f;
  const float inverse = 1.0f / (front > 0.0f ? w : 1.0f);
  const float px = h.x * inverse, py = h.y * inverse;
  const float reach = front > 0.0f ? px * px + py * py : std::numeric_limits<float>::infinity();
  const bool ok = reach < 1e18f;  // false for NaN, too
  x = ok ? px : 0.0f;
  y = ok ? py : 0.0f;
  found = ok ? 1.0f : 0.0f;
}

HOLDFAST_INLINE void project_to(const Projection& m, const Float3& point, bool valid, float& x,
                                float& y, float& found) {
  project_to(m, point, 1.0f, valid, x, y, found);
}

/// Position of pixel i of a block, relative to the camera, metres.
HOLDFAST_INLINE Float3 position(const BlockPixels& a, const float* depth, int i) {
  const float d = depth[i], scale = a.near_weight + a.far_weight * d;
  const float px = a.first_x + static_cast<float>(i);
  return {scale * (a.base[0] + px * a.across[0]) + d * a.forward[0],
          scale * (a.base[1] + px * a.across[1]) + d * a.forward[1],
          scale * (a.base[2] + px * a.across[2]) + d * a.forward[2]};
}

}  // namespace holdfast
