#include "core/history/tile_sums.h"

#include "core/kernels/variants.h"

namespace holdfast {
namespace {

constexpr int kLanes = kTilePixels;

/// One row of a tile, added to its sums. Each lane has sums of its own, so that what is summed in
/// which order does not depend on the instruction set.
struct TileRow {
  const float *depth, *samples, *history[3], *noisy[3];
  int channels, count;
  float *pixels, *square, *difference[3], *value[3];  ///< kLanes each
};

HOLDFAST_INLINE void add_row(const TileRow& a, int count) {
  float known[kLanes];
  for (int i = 0; i < count; ++i) {
    const float lit = a.samples[i] > 0.0f ? 1.0f : 0.0f;
    known[i] = a.depth[i] > 0.0f ? lit : 0.0f;
    a.pixels[i] += known[i];
  }
  for (int c = 0; c < a.channels; ++c) {
    const float *history = a.history[c], *noisy = a.noisy[c];
    float *difference = a.difference[c], *value = a.value[c], *square = a.square;
#pragma GCC ivdep
    for (int i = 0; i < count; ++i) {
      const float there = history[i], off = there - noisy[i];
      const float h = known[i] > 0.0f ? there : 0.0f, d = known[i] > 0.0f ? off : 0.0f;
      square[i] += d * d;
      difference[i] += d;
      value[i] += h;
    }
  }
}

HOLDFAST_INLINE void tile_row_body(const TileRow& a) {
  if (a.count == kLanes)
    add_row(a, kLanes);
  else
    add_row(a, a.count);
}

HOLDFAST_KERNEL(tile_row, TileRow)

double sum_of(const float* lanes) {
  double sum = 0;
  for (int i = 0; i < kLanes; ++i) sum += static_cast<double>(lanes[i]);
  return sum;
}

}  // namespace

TileSums sums_of_tile(const TileSignal& s, int x, int y) {
  float pixels[kLanes] = {}, square[kLanes] = {}, difference[3][kLanes] = {}, value[3][kLanes] = {};
  TileRow row{};
  row.channels = s.channels;
  row.count = std::min(kLanes, s.guides.view.width - x);
  row.pixels = pixels;
  row.square = square;
  for (int c = 0; c < s.channels; ++c) {
    row.difference[c] = difference[c];
    row.value[c] = value[c];
  }
  const int end = std::min(y + kTilePixels, s.guides.view.height);
  for (int line = y; line < end; ++line) {
    row.depth = s.guides.depth().row(line) + x;
    row.samples = s.samples.row(line) + x;
    for (int c = 0; c < s.channels; ++c) {
      row.history[c] = s.history[c].row(line) + x;
      row.noisy[c] = s.noisy[c].row(line) + x;
    }
    tile_row(row);
  }
  TileSums sums;
  sums.pixels = sum_of(pixels);
  sums.square = sum_of(square);
  for (int c = 0; c < s.channels; ++c) {
    sums.difference[c] = sum_of(difference[c]);
    sums.value[c] = sum_of(value[c]);
  }
  return sums;
}

}  // namespace holdfast
