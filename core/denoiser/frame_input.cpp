#include "core/denoiser/frame_input.h"

#include <algorithm>
#include <atomic>
#include <limits>

#include "core/kernels/parallel.h"
#include "core/kernels/variants.h"

namespace holdfast {
namespace {

/// Calls body(y) -> number of repaired values for every row, and returns their sum.
template <class Body>
std::uint64_t count_rows(int height, const Body& body) {
  std::atomic<std::uint64_t> total{0};
  for_each_row(height, [&](int y) {
    if (const std::uint64_t repaired = body(y)) total += repaired;
  });
  return total;
}

constexpr float kMost = std::numeric_limits<float>::max();

/// One row of depths or roughnesses, of normals or of a signal; `repaired` grows by the number of
/// repaired values.
struct ScalarRow {
  const float* in;
  int width;
  float* out;
  int* repaired;
};
struct NormalRow {
  const float *depth, *in[3];
  float towards_camera[3];
  int width;
  float* out[3];
  int* repaired;
};

struct SignalRow {
  const float* in;
  int width;
  float unknown, most, too_large;  ///< in place of what is no number, up to which is usable, beyond
  float* out;
  int* repaired;
};

HOLDFAST_INLINE void depth_row_body(const ScalarRow& a) {
  const float* __restrict in = a.in;
  float* __restrict out = a.out;
  int repaired = 0;
  for (int x = 0; x < a.width; ++x) {
    repaired += in[x] != in[x] ? 1 : 0;
    out[x] = in[x] > 0.0f && in[x] <= kMost ? in[x] : 0.0f;
  }
  *a.repaired += repaired;
}

HOLDFAST_INLINE void normal_row_body(const NormalRow& a) {
  const float* __restrict depth = a.depth;
  const float* __restrict nx = a.in[0];
  const float* __restrict ny = a.in[1];
  const float* __restrict nz = a.in[2];
  float* __restrict out_x = a.out[0];
  float* __restrict out_y = a.out[1];
  float* __restrict out_z = a.out[2];
  const float tx = a.towards_camera[0], ty = a.towards_camera[1], tz = a.towards_camera[2];
  int repaired = 0;
#pragma GCC ivdep
  for (int x = 0; x < a.width; ++x) {
    const float vx = nx[x], vy = ny[x], vz = nz[x];
    const float length = __builtin_sqrtf(vx * vx + vy * vy + vz * vz);
    const float not_long = length <= kLongestNormal ? length : 0.0f;
    const float usable = not_long >= kShortestNormal ? not_long : 0.0f;  // length, or 0
    const float scale = 1.0f / max_of(usable, kShortestNormal);
    const float own_x = vx * scale, own_y = vy * scale, own_z = vz * scale;
    const float ux = usable > 0.0f ? own_x : tx;
    const float uy = usable > 0.0f ? own_y : ty;
    const float uz = usable > 0.0f ? own_z : tz;
    const int bad = usable > 0.0f ? 0 : 1;
    out_x[x] = depth[x] > 0.0f ? ux : 0.0f;
    out_y[x] = depth[x] > 0.0f ? uy : 0.0f;
    out_z[x] = depth[x] > 0.0f ? uz : 0.0f;
    repaired += depth[x] > 0.0f ? bad : 0;
  }
  *a.repaired += repaired;
}

HOLDFAST_INLINE void roughness_row_body(const ScalarRow& a) {
  const float* __restrict in = a.in;
  float* __restrict out = a.out;
  int repaired = 0;
  for (int x = 0; x < a.width; ++x) {
    const float v = in[x];
    const float inside = v <= 1.0f ? v : 1.0f;
    const int beyond = v <= 1.0f ? 0 : 1;
    const float below = v < 0.0f ? 0.0f : 1.0f;
    out[x] = v >= 0.0f ? inside : below;
    repaired += v >= 0.0f ? beyond : 1;
  }
  *a.repaired += repaired;
}

HOLDFAST_INLINE void signal_row_body(const SignalRow& a) {
  const float* __restrict in = a.in;
  float* __restrict out = a.out;
  const float unknown = a.unknown, most = a.most, too_large = a.too_large;
  int repaired = 0;
  for (int x = 0; x < a.width; ++x) {
    const float v = in[x];
    const float finite = v <= kMost ? too_large : unknown;
    const float positive = v <= most ? v : finite;
    const int beyond = v <= most ? 0 : 1;
    out[x] = v >= 0.0f ? positive : unknown;
    repaired += v >= 0.0f ? beyond : 1;
  }
  *a.repaired += repaired;
}

HOLDFAST_KERNEL(signal_row, SignalRow)
HOLDFAST_KERNEL(depth_row, ScalarRow)
HOLDFAST_KERNEL(normal_row, NormalRow)
HOLDFAST_KERNEL(roughness_row, ScalarRow)

}  // namespace

std::uint64_t load_depth(const Plane& depth, Guides& out) {
  const auto in = depth.channel(0);
  return count_rows(in.height, [&](int y) {
    int repaired = 0;
    depth_row({in.row(y), in.width, out.depth_normal[0].row(y), &repaired});
    return static_cast<std::uint64_t>(repaired);
  });
}

std::uint64_t load_normals(const Plane& normal, Guides& out) {
  const glm::vec3 towards = -glm::normalize(out.rays.forward);
  return count_rows(normal.height(), [&](int y) {
    int repaired = 0;
    NormalRow row{out.depth().row(y), {}, {towards.x, towards.y, towards.z},
                  normal.width(),     {}, &repaired};
    for (int axis = 0; axis < 3; ++axis) {
      row.in[axis] = normal.channel(axis).row(y);
      row.out[axis] = out.depth_normal[1 + axis].row(y);
    }
    normal_row(row);
    return static_cast<std::uint64_t>(repaired);
  });
}

void load_ids(const Plane* ids, Channels<std::uint32_t>& out) {
  for_each_row(out.height(), [&](int y) {
    if (ids != nullptr)
      std::copy_n(ids->ids().row(y), ids->width(), out[0].row(y));
    else
      std::fill_n(out[0].row(y), out.width(), 0u);
  });
}

std::uint64_t load_roughness(const Plane& roughness, Guides& out) {
  return count_rows(roughness.height(), [&](int y) {
    int repaired = 0;
    roughness_row(
        {roughness.channel(0).row(y), roughness.width(), out.roughness[0].row(y), &repaired});
    return static_cast<std::uint64_t>(repaired);
  });
}

void load_motion(const Plane& motion, Guides& out) {
  for_each_row(motion.height(), [&](int y) {
    for (int c = 0; c < 2; ++c)
      std::copy_n(motion.channel(c).row(y), motion.width(), out.motion[c].row(y));
  });
}

std::uint64_t load_signal(const Plane& plane, Channels<float>& out) {
  const bool visibility = plane.id().kind == PlaneKind::kVisibility;
  const float unknown = visibility ? 1.0f : 0.0f;
  const float most = visibility ? kLargestVisibility : kLargestRadiance;
  const float too_large = visibility ? unknown : kLargestRadiance;
  return count_rows(plane.height(), [&](int y) {
    int repaired = 0;
    for (int c = 0; c < plane.channels(); ++c)
      signal_row({plane.channel(c).row(y), plane.width(), unknown, most, too_large, out[c].row(y),
                  &repaired});
    return static_cast<std::uint64_t>(repaired);
  });
}

}  // namespace holdfast
