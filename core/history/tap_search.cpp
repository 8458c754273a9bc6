#include "core/history/tap_search.h"

#include <algorithm>
#include <cmath>

#include "core/history/tap_lanes.h"
#include "core/kernels/variants.h"
#include "core/motion/plain_math.h"

namespace holdfast {
namespace {

static_assert(kFollowBlock <= kTapBlock);

/// What is found, before it is written as taps.
struct FoundTaps {
  TapLanes lanes;
  float column[kFollowBlock], row[kFollowBlock];  ///< of the first of the four pixels
  std::int32_t lost[kFollowBlock];                ///< 1: none of the four is valid
  std::int32_t any_lost = 0;                      ///< 1: any of them is
  float any[kFollowBlock];                        ///< 1: there are taps
};

/// What the previous frame shows at the four pixels; depth 0 where there is none.
struct Shown {
  float depth[4][kFollowBlock], normal[4][3][kFollowBlock];
  std::uint32_t id[4][kFollowBlock];
};

struct SearchBlock {
  const TapSearch& search;
  FoundTaps& out;
};

HOLDFAST_INLINE int floor_of(float v) {
  const int truncated = static_cast<int>(v);
  return v < static_cast<float>(truncated) ? truncated - 1 : truncated;
}

/// Weight of the pixel at `at`, of a bilinear pair that starts at `start`: at the borders of the
/// image the four pixels are not those of the pair.
HOLDFAST_INLINE float pair_weight(int at, int start, float f) {
  const float second = at == start + 1 ? f : 0.0f;
  return at == start ? 1.0f - f : second;
}

/// A weight too small to count is left out.
HOLDFAST_INLINE float counted(float weight) { return weight < kLeastTapWeight ? 0.0f : weight; }

/// Where the four pixels begin, and their bilinear weights; 0 where nothing can be found.
HOLDFAST_INLINE void place_taps(const TapSearch& a, FoundTaps& out) {
  const int width = a.previous.view.width, height = a.previous.view.height;
  const int last_x = max_of(width - 2, 0), last_y = max_of(height - 2, 0);
  const float second_x = width > 1 ? 1.0f : 0.0f, second_y = height > 1 ? 1.0f : 0.0f;
  const auto stride = static_cast<std::int32_t>(a.previous.depth().stride);
  const auto right = static_cast<float>(width + 1), bottom = static_cast<float>(height + 1);
  const float *px = a.followed.x, *py = a.followed.y, *found = a.followed.found;
  out.lanes.count = a.count;
#pragma GCC ivdep
  for (int i = 0; i < a.count; ++i) {
    // Beyond one pixel outside, no tap can be inside; also keeps the conversion to int in range.
    const float x_inside = (px[i] > -1.0f ? 1.0f : 0.0f) * (px[i] < right ? 1.0f : 0.0f);
    const float y_inside = (py[i] > -1.0f ? 1.0f : 0.0f) * (py[i] < bottom ? 1.0f : 0.0f);
    const float inside = (found[i] > 0.0f ? 1.0f : 0.0f) * x_inside * y_inside;
    const float cx = min_of(max_of(px[i], -1.0f), right) - 0.5f;  // -1.5 for NaN
    const float cy = min_of(max_of(py[i], -1.0f), bottom) - 0.5f;
    const int ix = floor_of(cx), iy = floor_of(cy);
    const float fx = cx - static_cast<float>(ix), fy = cy - static_cast<float>(iy);
    const int bx = min_of(max_of(ix, 0), last_x), by = min_of(max_of(iy, 0), last_y);
    const float x0 = inside * pair_weight(bx, ix, fx);
    const float x1 = inside * second_x * pair_weight(bx + 1, ix, fx);
    const float y0 = pair_weight(by, iy, fy), y1 = second_y * pair_weight(by + 1, iy, fy);
    out.lanes.offset[i] = by * stride + bx;
    out.column[i] = static_cast<float>(bx);
    out.row[i] = static_cast<float>(by);
    out.lanes.weight[0][i] = counted(x0 * y0);
    out.lanes.weight[1][i] = counted(x1 * y0);
    out.lanes.weight[2][i] = counted(x0 * y1);
    out.lanes.weight[3][i] = counted(x1 * y1);
    out.lost[i] = static_cast<std::int32_t>(inside);
  }
}

/// Reads what the previous frame shows.
HOLDFAST_INLINE void look(const TapSearch& a, const TapLanes& lanes, Shown& out) {
  const Guides& g = a.previous;
  for (int k = 0; k < 4; ++k) {
    const int dx = k % 2, dy = k / 2;
    if (dx >= g.view.width || dy >= g.view.height) {
      for (int i = 0; i < a.count; ++i) out.depth[k][i] = 0.0f;
      continue;
    }
    const std::ptrdiff_t at = dy * g.depth().stride + dx;
    fetch(lanes, g.depth().data + at, out.depth[k]);
    for (int axis = 0; axis < 3; ++axis)
      fetch(lanes, g.normal(axis).data + at, out.normal[k][axis]);
    fetch(lanes, g.id[0].data + at, out.id[k]);
  }
}

/// A receiver and what its plane makes of the previous frame's rays.
struct SoughtPlane {
  Float3 normal;
  float offset, forward, near_weight, far_weight, tolerance;
  std::uint32_t id;
};

/// The weight that a pixel keeps whose ray is `lateral` along the receiver's normal: `TapTest` of
/// taps.cpp.
HOLDFAST_INLINE float kept_weight(const SoughtPlane& p, float lateral, float depth, float nx,
                                  float ny, float nz, std::uint32_t id, float weight) {
  const float scale = p.near_weight + p.far_weight * depth;
  const float distance = abs_of(scale * lateral + depth * p.forward - p.offset);
  const float cosine = dot(p.normal, {nx, ny, nz});
  const float on_plane = distance <= p.tolerance * scale ? weight : 0.0f;
  const float facing = cosine >= kTapNormalCosine ? on_plane : 0.0f;
  const float surface = depth > 0.0f ? facing : 0.0f;
  return id == p.id ? surface : 0.0f;
}

/// Takes the weight from those of the four pixels that show another receiver, and normalises what
/// is left.
HOLDFAST_INLINE void test_receivers(const TapSearch& a, const Shown& shown, FoundTaps& out) {
  const PixelRays<float>& rays = a.previous.rays;
  const Float3 lateral_0{rays.lateral_0.x, rays.lateral_0.y, rays.lateral_0.z},
      lateral_x{rays.lateral_x.x, rays.lateral_x.y, rays.lateral_x.z},
      lateral_y{rays.lateral_y.x, rays.lateral_y.y, rays.lateral_y.z},
      forward{rays.forward.x, rays.forward.y, rays.forward.z};
  const float near_weight = rays.near_weight, far_weight = rays.far_weight;
  const float tolerance = tap_tolerance(a.previous);
  const float *px = a.followed.point[0], *py = a.followed.point[1], *pz = a.followed.point[2];
  const float *nx = a.followed.normal[0], *ny = a.followed.normal[1], *nz = a.followed.normal[2];
  float *w0 = out.lanes.weight[0], *w1 = out.lanes.weight[1], *w2 = out.lanes.weight[2],
        *w3 = out.lanes.weight[3];
#pragma GCC ivdep
  for (int i = 0; i < a.count; ++i) {
    const Float3 n{nx[i], ny[i], nz[i]};
    const SoughtPlane p{
        n,      dot(n, {px[i], py[i], pz[i]}), dot(n, forward), near_weight, far_weight, tolerance,
        a.id[i]};
    const float start = dot(n, lateral_0), across = dot(n, lateral_x), down = dot(n, lateral_y);
    const float x0 = out.column[i] + 0.5f, y0 = out.row[i] + 0.5f;
    const float left = start + x0 * across, right = start + (x0 + 1.0f) * across;
    const float upper = y0 * down, lower = (y0 + 1.0f) * down;
    const float k0 =
        kept_weight(p, left + upper, shown.depth[0][i], shown.normal[0][0][i],
                    shown.normal[0][1][i], shown.normal[0][2][i], shown.id[0][i], w0[i]);
    const float k1 =
        kept_weight(p, right + upper, shown.depth[1][i], shown.normal[1][0][i],
                    shown.normal[1][1][i], shown.normal[1][2][i], shown.id[1][i], w1[i]);
    const float k2 =
        kept_weight(p, left + lower, shown.depth[2][i], shown.normal[2][0][i],
                    shown.normal[2][1][i], shown.normal[2][2][i], shown.id[2][i], w2[i]);
    const float k3 =
        kept_weight(p, right + lower, shown.depth[3][i], shown.normal[3][0][i],
                    shown.normal[3][1][i], shown.normal[3][2][i], shown.id[3][i], w3[i]);
    w0[i] = k0;
    w1[i] = k1;
    w2[i] = k2;
    w3[i] = k3;
  }
}

/// Takes the weight from the pixels at (dx, dy) of the four that show no surface.
HOLDFAST_INLINE void test_surfaces(const TapSearch& a, int dx, int dy, FoundTaps& out) {
  float depth[kFollowBlock];
  fetch(out.lanes, a.previous.depth().data + dy * a.previous.depth().stride + dx, depth);
  float* weight = out.lanes.weight[2 * dy + dx];
#pragma GCC ivdep
  for (int i = 0; i < a.count; ++i) weight[i] = depth[i] > 0.0f ? weight[i] : 0.0f;
}

/// Of a single pixel exactly to 1, as a quotient would be.
HOLDFAST_INLINE void normalise_weights(int count, FoundTaps& out) {
  float *w0 = out.lanes.weight[0], *w1 = out.lanes.weight[1], *w2 = out.lanes.weight[2],
        *w3 = out.lanes.weight[3];
  int any_lost = 0;
#pragma GCC ivdep
  for (int i = 0; i < count; ++i) {
    const float sum = w0[i] + w1[i] + w2[i] + w3[i];
    const float kept = sum > kLeastTapSum ? 1.0f : 0.0f, divisor = sum > kLeastTapSum ? sum : 1.0f;
    const std::int32_t lost = sum > kLeastTapSum ? 0 : out.lost[i];
    out.lost[i] = lost;
    any_lost |= lost;
    out.any[i] = kept;
    const float inverse = kept / divisor;
    const float n0 = w0[i] * inverse, n1 = w1[i] * inverse, n2 = w2[i] * inverse,
                n3 = w3[i] * inverse;
    const float left = 1.0f - (n0 + n1 + n2 + n3);
    w0[i] = n0 + n0 * left;
    w1[i] = n1 + n1 * left;
    w2[i] = n2 + n2 * left;
    w3[i] = n3 + n3 * left;
  }
  out.any_lost = any_lost;
}

/// Leaves out what is of another roughness.
HOLDFAST_INLINE void test_roughness(const TapSearch& a, FoundTaps& out) {
  const float* wanted = a.roughness;
  float there[kFollowBlock];
  gather_lanes(a.previous.roughness[0], out.lanes, there);
  float *w0 = out.lanes.weight[0], *w1 = out.lanes.weight[1], *w2 = out.lanes.weight[2],
        *w3 = out.lanes.weight[3];
#pragma GCC ivdep
  for (int i = 0; i < a.count; ++i) {
    const float same = abs_of(there[i] - wanted[i]) <= kTapRoughnessTolerance ? 1.0f : 0.0f;
    out.any[i] *= same;
    w0[i] *= same;
    w1[i] *= same;
    w2[i] *= same;
    w3[i] *= same;
  }
}

HOLDFAST_INLINE void receivers_body(const SearchBlock& a) {
  place_taps(a.search, a.out);
  find_runs(a.out.lanes, a.search.previous.depth());
  Shown shown;
  look(a.search, a.out.lanes, shown);
  test_receivers(a.search, shown, a.out);
  normalise_weights(a.search.count, a.out);
  if (a.search.roughness != nullptr) test_roughness(a.search, a.out);
}

HOLDFAST_INLINE void surfaces_body(const SearchBlock& a) {
  const int columns = min_of(a.search.previous.view.width, 2);
  const int rows = min_of(a.search.previous.view.height, 2);
  place_taps(a.search, a.out);
  find_runs(a.out.lanes, a.search.previous.depth());
  for (int dy = 0; dy < rows; ++dy)
    for (int dx = 0; dx < columns; ++dx) test_surfaces(a.search, dx, dy, a.out);
  normalise_weights(a.search.count, a.out);
}

HOLDFAST_KERNEL(receivers, SearchBlock)
HOLDFAST_KERNEL(surfaces, SearchBlock)

void write_taps(const TapLanes& lanes, Taps* taps) {
  for (int i = 0; i < lanes.count; ++i)
    taps[i] = {lanes.offset[i],
               {lanes.weight[0][i], lanes.weight[1][i], lanes.weight[2][i], lanes.weight[3][i]}};
}

bool is_as_rough(const Guides& previous, const Taps& taps, float roughness) {
  return std::abs(gather(previous.roughness[0], taps) - roughness) <= kTapRoughnessTolerance;
}

}  // namespace

void find_block_taps(const TapSearch& search) {
  FoundTaps found;
  receivers({search, found});
  write_taps(found.lanes, search.taps);
  const FollowedBlock& at = search.followed;
  for (int i = 0; found.any_lost != 0 && i < search.count; ++i) {
    if (!found.lost[i]) continue;
    Taps taps = rescue_taps(search.previous, at.x[i], at.y[i], receiver_of(at, i, search.id[i]));
    if (search.roughness != nullptr && !is_as_rough(search.previous, taps, search.roughness[i]))
      taps = Taps{};
    search.taps[i] = taps;
    found.any[i] = taps.any() ? 1.0f : 0.0f;
  }
  if (search.any != nullptr) std::copy_n(found.any, search.count, search.any);
}

void find_block_taps_on_any_surface(const TapSearch& search) {
  FoundTaps found;
  surfaces({search, found});
  write_taps(found.lanes, search.taps);
  for (int i = 0; found.any_lost != 0 && i < search.count; ++i) {
    if (!found.lost[i]) continue;
    search.taps[i] =
        rescue_taps_on_any_surface(search.previous, search.followed.x[i], search.followed.y[i]);
    found.any[i] = search.taps[i].any() ? 1.0f : 0.0f;
  }
  if (search.any != nullptr) std::copy_n(found.any, search.count, search.any);
}

}  // namespace holdfast
