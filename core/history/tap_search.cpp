#include "core/history/tap_search.h"

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
};

/// What the previous frame shows at one of the four pixels.
struct Shown {
  float depth[kFollowBlock], normal[3][kFollowBlock];
  std::uint32_t id[kFollowBlock];
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

/// Takes the weight from the pixels at (dx, dy) of the four that show another receiver.
HOLDFAST_INLINE void test_receivers(const TapSearch& a, int dx, int dy, FoundTaps& out) {
  const Guides& g = a.previous;
  const std::ptrdiff_t at = dy * g.depth().stride + dx;
  Shown shown;
  fetch(out.lanes, g.depth().data + at, shown.depth);
  for (int axis = 0; axis < 3; ++axis)
    fetch(out.lanes, g.normal(axis).data + at, shown.normal[axis]);
  fetch(out.lanes, g.id[0].data + at, shown.id);
  const PixelRays<float>& rays = g.rays;
  const float l0x = rays.lateral_0.x, l0y = rays.lateral_0.y, l0z = rays.lateral_0.z;
  const float lxx = rays.lateral_x.x, lxy = rays.lateral_x.y, lxz = rays.lateral_x.z;
  const float lyx = rays.lateral_y.x, lyy = rays.lateral_y.y, lyz = rays.lateral_y.z;
  const float fx = rays.forward.x, fy = rays.forward.y, fz = rays.forward.z;
  const float near_w = rays.near_weight, far_w = rays.far_weight;
  const auto angle = static_cast<float>(g.view.pixel_angle);
  const float centre_x = static_cast<float>(dx) + 0.5f, centre_y = static_cast<float>(dy) + 0.5f;
  const float *px = a.followed.point[0], *py = a.followed.point[1], *pz = a.followed.point[2];
  const float *nx = a.followed.normal[0], *ny = a.followed.normal[1], *nz = a.followed.normal[2];
  float* weight = out.lanes.weight[2 * dy + dx];
#pragma GCC ivdep
  for (int i = 0; i < a.count; ++i) {
    const Float3 n{nx[i], ny[i], nz[i]};
    const float plane = dot(n, {px[i], py[i], pz[i]});
    const float d = shown.depth[i], scale = near_w + far_w * d;
    const float x = out.column[i] + centre_x, y = out.row[i] + centre_y;
    const Float3 point{scale * (l0x + x * lxx + y * lyx) + d * fx,
                       scale * (l0y + x * lxy + y * lyy) + d * fy,
                       scale * (l0z + x * lxz + y * lyz) + d * fz};
    const float distance = abs_of(dot(n, point) - plane);
    const float cosine = dot(n, {shown.normal[0][i], shown.normal[1][i], shown.normal[2][i]});
    const float on_plane = distance <= kTapPlaneTolerancePx * (angle * scale) ? weight[i] : 0.0f;
    const float facing = cosine >= kTapNormalCosine ? on_plane : 0.0f;
    const float surface = d > 0.0f ? facing : 0.0f;
    weight[i] = shown.id[i] == a.id[i] ? surface : 0.0f;
  }
}

/// The same, of those that show no surface.
HOLDFAST_INLINE void test_surfaces(const TapSearch& a, int dx, int dy, FoundTaps& out) {
  float depth[kFollowBlock];
  fetch(out.lanes, a.previous.depth().data + dy * a.previous.depth().stride + dx, depth);
  float* weight = out.lanes.weight[2 * dy + dx];
#pragma GCC ivdep
  for (int i = 0; i < a.count; ++i) weight[i] = depth[i] > 0.0f ? weight[i] : 0.0f;
}

HOLDFAST_INLINE void normalise_weights(int count, FoundTaps& out) {
  float *w0 = out.lanes.weight[0], *w1 = out.lanes.weight[1], *w2 = out.lanes.weight[2],
        *w3 = out.lanes.weight[3];
#pragma GCC ivdep
  for (int i = 0; i < count; ++i) {
    const float sum = w0[i] + w1[i] + w2[i] + w3[i];
    const float kept = sum > kLeastTapSum ? 1.0f : 0.0f, divisor = sum > kLeastTapSum ? sum : 1.0f;
    out.lost[i] = sum > kLeastTapSum ? 0 : out.lost[i];
    w0[i] = kept * w0[i] / divisor;
    w1[i] = kept * w1[i] / divisor;
    w2[i] = kept * w2[i] / divisor;
    w3[i] = kept * w3[i] / divisor;
  }
}

HOLDFAST_INLINE void receivers_body(const SearchBlock& a) {
  const int columns = min_of(a.search.previous.view.width, 2);
  const int rows = min_of(a.search.previous.view.height, 2);
  place_taps(a.search, a.out);
  find_runs(a.out.lanes, a.search.previous.depth());
  for (int dy = 0; dy < rows; ++dy)
    for (int dx = 0; dx < columns; ++dx) test_receivers(a.search, dx, dy, a.out);
  normalise_weights(a.search.count, a.out);
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

}  // namespace

void find_block_taps(const TapSearch& search) {
  FoundTaps found;
  receivers({search, found});
  write_taps(found.lanes, search.taps);
  const FollowedBlock& at = search.followed;
  for (int i = 0; i < search.count; ++i)
    if (found.lost[i])
      search.taps[i] =
          rescue_taps(search.previous, at.x[i], at.y[i], receiver_of(at, i, search.id[i]));
}

void find_block_taps_on_any_surface(const TapSearch& search) {
  FoundTaps found;
  surfaces({search, found});
  write_taps(found.lanes, search.taps);
  for (int i = 0; i < search.count; ++i)
    if (found.lost[i])
      search.taps[i] =
          rescue_taps_on_any_surface(search.previous, search.followed.x[i], search.followed.y[i]);
}

}  // namespace holdfast
