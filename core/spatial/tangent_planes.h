#pragma once

#include "core/frame/guides.h"
#include "core/kernels/math.h"

namespace holdfast {

/// The tangent planes of up to N neighbouring pixels of one row, so that the distance of a point
/// near one of them costs a few products. The point at depth d and offset (dx, dy) pixels lies
///   d (plane_0 + dx plane_x + dy plane_y) + offset_0 + dx offset_x + dy offset_y
/// from the plane, in units of the tolerance that the planes were loaded with.
template <int N>
struct TangentPlanes {
  float plane_0[N], plane_x[N], plane_y[N];
  float offset_0[N], offset_x[N], offset_y[N];
  float nx[N], ny[N], nz[N];  ///< normals
};

/// Loads pixels (x0, y) to (x0 + count - 1, y), count <= N. The tolerance is `tolerance_px` widths
/// of a pixel at the pixel's depth. Pixels without surface get finite values of no meaning.
template <int N>
HOLDFAST_INLINE void load_tangent_planes(const Guides& guides, float tolerance_px, int x0, int y,
                                         int count, TangentPlanes<N>& b) {
  const PixelRays<float>& rays = guides.rays;
  const float py = static_cast<float>(y) + 0.5f;
  const float l0x = rays.lateral_0.x + py * rays.lateral_y.x;
  const float l0y = rays.lateral_0.y + py * rays.lateral_y.y;
  const float l0z = rays.lateral_0.z + py * rays.lateral_y.z;
  const float lxx = rays.lateral_x.x, lxy = rays.lateral_x.y, lxz = rays.lateral_x.z;
  const float lyx = rays.lateral_y.x, lyy = rays.lateral_y.y, lyz = rays.lateral_y.z;
  const float fx = rays.forward.x, fy = rays.forward.y, fz = rays.forward.z;
  const float near_w = rays.near_weight, far_w = rays.far_weight;
  const float tolerance = tolerance_px * static_cast<float>(guides.view.pixel_angle);
  const float* __restrict depth = guides.depth().row(y) + x0;
  const float* __restrict gx = guides.normal(0).row(y) + x0;
  const float* __restrict gy = guides.normal(1).row(y) + x0;
  const float* __restrict gz = guides.normal(2).row(y) + x0;
#pragma GCC ivdep
  for (int i = 0; i < count; ++i) {
    const float d = depth[i] > 0.0f ? depth[i] : 1.0f;
    const float inverse = 1.0f / (tolerance * (near_w + far_w * d));
    const float px = static_cast<float>(x0 + i) + 0.5f;
    const float nx = gx[i], ny = gy[i], nz = gz[i];
    const float n_lateral =
        (nx * (l0x + px * lxx) + ny * (l0y + px * lxy) + nz * (l0z + px * lxz)) * inverse;
    const float n_x = (nx * lxx + ny * lxy + nz * lxz) * inverse;
    const float n_y = (nx * lyx + ny * lyy + nz * lyz) * inverse;
    const float n_forward = (nx * fx + ny * fy + nz * fz) * inverse;
    b.nx[i] = nx;
    b.ny[i] = ny;
    b.nz[i] = nz;
    b.plane_0[i] = far_w * n_lateral + n_forward;
    b.plane_x[i] = far_w * n_x;
    b.plane_y[i] = far_w * n_y;
    b.offset_0[i] = near_w * n_lateral - ((near_w + far_w * d) * n_lateral + d * n_forward);
    b.offset_x[i] = near_w * n_x;
    b.offset_y[i] = near_w * n_y;
  }
}

}  // namespace holdfast
