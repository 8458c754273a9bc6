#include "core/spatial/tap_weights.h"

#include <algorithm>

#include "core/kernels/variants.h"
#include "core/spatial/tangent_planes.h"

namespace holdfast {
namespace {

constexpr int kTile = ActivityMap::kTileWidth;
constexpr int kBlock = 64;  // pixels at a time

/// Pixels of a row whose weights are to be found.
struct WeightBlock {
  const Guides& guides;
  const FilterWeights& weights;
  int step, x0, y, count;  ///< 1..kBlock pixels
  std::uint32_t* out[TapWeights::kPairs];
};

/// The tangent planes of the block, and normals times their power.
using Planes = TangentPlanes<kBlock>;

/// Weights of the taps (dx, dy) away, times kOne, into one half of the words, the other of which
/// stays as it is: `shift` 0 or 16.
HOLDFAST_INLINE void add_half(const WeightBlock& a, const Planes& b, int dx, int dy, int shift,
                              std::uint32_t* __restrict words) {
  const int qy = a.y + dy, width = a.guides.view.width;
  if (qy < 0 || qy >= a.guides.view.height) return;
  const int first = max_of(0, -(a.x0 + dx)), last = min_of(a.count, width - dx - a.x0);
  const float *depth = a.guides.depth().row(qy) + a.x0 + dx,
              *nx = a.guides.normal(0).row(qy) + a.x0 + dx,
              *ny = a.guides.normal(1).row(qy) + a.x0 + dx,
              *nz = a.guides.normal(2).row(qy) + a.x0 + dx;
  const float fx = static_cast<float>(dx), fy = static_cast<float>(dy);
  const float power = a.weights.normal_power, bits_of_one = weight_bits(0.0f);
#pragma GCC ivdep
  for (int i = first; i < last; ++i) {
    const float plane = b.plane_0[i] + fy * b.plane_y[i] + fx * b.plane_x[i];
    const float offset = b.offset_0[i] + fy * b.offset_y[i] + fx * b.offset_x[i];
    const float turned = power - b.nx[i] * nx[i] - b.ny[i] * ny[i] - b.nz[i] * nz[i];
    const float exponent = abs_of(depth[i] * plane + offset) + positive_part(turned);
    const float weight = min_of(weight_exp(bits_of_one, exponent), 1.0f);
    const auto kept = static_cast<std::int32_t>(weight * TapWeights::kOne + 0.5f);
    words[i] |= static_cast<std::uint32_t>(kept) << shift;
  }
}

HOLDFAST_INLINE void find_weights_body(const WeightBlock& a) {
  Planes planes;
  load_tangent_planes(a.guides, a.weights.plane_sigma_px * static_cast<float>(a.step), a.x0, a.y,
                      a.count, planes);
  for (float* normal : {planes.nx, planes.ny, planes.nz})
    for (int i = 0; i < a.count; ++i) normal[i] *= a.weights.normal_power;
  for (int pair = 0; pair < TapWeights::kPairs; ++pair)
    for (int i = 0; i < a.count; ++i) a.out[pair][i] = 0;
  const int s = a.step;
  add_half(a, planes, -s, -s, 0, a.out[TapWeights::kAbove]);
  add_half(a, planes, s, -s, 16, a.out[TapWeights::kAbove]);
  add_half(a, planes, -s, 0, 0, a.out[TapWeights::kBeside]);
  add_half(a, planes, s, 0, 16, a.out[TapWeights::kBeside]);
  add_half(a, planes, -s, s, 0, a.out[TapWeights::kBelow]);
  add_half(a, planes, s, s, 16, a.out[TapWeights::kBelow]);
  add_half(a, planes, 0, -s, 0, a.out[TapWeights::kColumn]);
  add_half(a, planes, 0, s, 16, a.out[TapWeights::kColumn]);
}

HOLDFAST_KERNEL(find_weights, WeightBlock)

}  // namespace

TapWeights::TapWeights(int width, int height, Memory memory)
    : words_(width, height, kSteps * kPairs, memory),
      tiles_((width + kTile - 1) / kTile),
      height_(height),
      known_(static_cast<std::size_t>(kSteps * height) * static_cast<std::size_t>(tiles_)) {}

void TapWeights::clear() { std::fill(known_.begin(), known_.end(), std::uint8_t{0}); }

void TapWeights::provide(const Guides& guides, const FilterWeights& weights, int step, int x0,
                         int y, int count) {
  std::uint8_t* known = &known_[static_cast<std::size_t>((step - 1) * height_ + y) *
                                static_cast<std::size_t>(tiles_)];
  const int end = x0 + count;
  for (int x = x0; x < end;) {
    if (known[x / kTile] != 0) {
      x += kTile;
      continue;
    }
    int last = x;
    while (last < end && last - x < kBlock && known[last / kTile] == 0) {
      known[last / kTile] = 1;
      last += kTile;
    }
    last = std::min(last, end);
    WeightBlock block{guides, weights, step, x, y, last - x, {}};
    for (int pair = 0; pair < kPairs; ++pair)
      block.out[pair] = words_[(step - 1) * kPairs + pair].row(y) + x;
    find_weights(block);
    x = last;
  }
}

}  // namespace holdfast
