#include "core/spatial/tap_weights.h"

#include <algorithm>

#include "core/kernels/variants.h"
#include "core/spatial/filter_taps.h"
#include "core/spatial/tangent_planes.h"

namespace holdfast {
namespace {

constexpr int kTile = ActivityMap::kTileWidth;

/// Pixels of a row whose weights are to be found, for a pass of that step, guides and weights.
struct WeightBlock {
  const FilterPass& pass;
  int x0, y, count;  ///< 1..kFilterBlock pixels
  std::uint32_t* out[TapWeights::kPairs];
};

/// The tap that lies (dx, dy) from the pixels of a block.
struct GeometryTap {
  const TapRow& row;
  int dx, dy;
};

HOLDFAST_INLINE std::uint32_t kept_weight(const FilterBlock& b, const GeometryTap& tap, int i) {
  const float dx = static_cast<float>(tap.dx), dy = static_cast<float>(tap.dy);
  const int q = i + tap.dx;
  const float plane = b.plane_0[i] + dy * b.plane_y[i] + dx * b.plane_x[i];
  const float offset = b.offset_0[i] + dy * b.offset_y[i] + dx * b.offset_x[i];
  const float turned = tap.row.normal_power - b.nx[i] * tap.row.nx[q] - b.ny[i] * tap.row.ny[q] -
                       b.nz[i] * tap.row.nz[q];
  const float exponent = abs_of(tap.row.depth[q] * plane + offset) + positive_part(turned);
  // weight_exp may exceed 1 by its error, which the rounding takes away again.
  const float weight = weight_exp(weight_bits(0.0f), exponent);
  return static_cast<std::uint32_t>(static_cast<std::int32_t>(weight * TapWeights::kOne + 0.5f));
}

HOLDFAST_INLINE void find_pair(const FilterBlock& b, GeometryTap lower, GeometryTap upper,
                               int count, std::uint32_t* out) {
#pragma GCC ivdep
  for (int i = 0; i < count; ++i)
    out[i] = kept_weight(b, lower, i) | kept_weight(b, upper, i) << 16;
}

/// Where a row is outside the image: nothing has weight.
HOLDFAST_INLINE TapRow row_without_surface(const FilterPass& a,
                                           PaddedRows<TapWeights::kSteps>& padded) {
  for (float& value : padded.values[0]) value = 0.0f;
  TapRow t{};
  t.depth = t.nx = t.ny = t.nz = padded.values[0] + PaddedRows<TapWeights::kSteps>::kRoom;
  t.normal_power = a.weights.normal_power;
  return t;
}

HOLDFAST_INLINE void find_weights_body(const WeightBlock& block) {
  constexpr TapReads kReads{true, false, false};
  const FilterPass& a = block.pass;
  const int step = a.step, height = a.guides->view.height, x0 = block.x0, y = block.y;
  const int count = block.count;
  FilterBlock b;
  load_tangent_planes(*a.guides, a.weights.plane_sigma_px * static_cast<float>(step), x0, y, count,
                      b);
  for (float* normal : {b.nx, b.ny, b.nz})
    for (int i = 0; i < count; ++i) normal[i] *= a.weights.normal_power;
  PaddedRows<TapWeights::kSteps> padded[3];
  TapRow rows[3];
  const bool inside = has_apron(a) || is_inside(a, x0, count);
  for (int k = 0; k < 3; ++k) {
    const int qy = y + (k - 1) * step;
    const bool exists = qy >= 0 && qy < height;
    if (!exists)
      rows[k] = row_without_surface(a, padded[k]);
    else if (inside)
      rows[k] = tap_row<0, kReads>(a, x0, qy);
    else
      rows[k] = padded_tap_row<0, kReads>(a, x0, count, qy, padded[k]);
  }
  const TapRow &above = rows[0], &own = rows[1], &below = rows[2];
  find_pair(b, {above, -step, -step}, {above, step, -step}, count, block.out[TapWeights::kAbove]);
  find_pair(b, {own, -step, 0}, {own, step, 0}, count, block.out[TapWeights::kBeside]);
  find_pair(b, {below, -step, step}, {below, step, step}, count, block.out[TapWeights::kBelow]);
  find_pair(b, {above, 0, -step}, {below, 0, step}, count, block.out[TapWeights::kColumn]);
}

HOLDFAST_KERNEL(find_weights, WeightBlock)

}  // namespace

TapWeights::TapWeights(int width, int height, Memory memory)
    : words_(width, height, kSteps * kPairs, memory),
      tiles_((width + kTile - 1) / kTile),
      height_(height),
      known_(static_cast<std::size_t>(kSteps * height) * static_cast<std::size_t>(tiles_)) {}

void TapWeights::clear() { std::fill(known_.begin(), known_.end(), std::uint8_t{0}); }

void TapWeights::provide(const FilterPass& pass, int x0, int y, int count) {
  const int step = pass.step;
  std::uint8_t* known = &known_[static_cast<std::size_t>((step - 1) * height_ + y) *
                                static_cast<std::size_t>(tiles_)];
  const int end = x0 + count;
  for (int x = x0; x < end;) {
    if (known[x / kTile] != 0) {
      x += kTile;
      continue;
    }
    int last = x;
    while (last < end && last - x < kFilterBlock && known[last / kTile] == 0) {
      known[last / kTile] = 1;
      last += kTile;
    }
    last = std::min(last, end);
    WeightBlock block{pass, x, y, last - x, {}};
    for (int pair = 0; pair < kPairs; ++pair)
      block.out[pair] = words_[(step - 1) * kPairs + pair].row(y) + x;
    find_weights(block);
    x = last;
  }
}

}  // namespace holdfast
