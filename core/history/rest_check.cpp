#include "core/history/rest_check.h"

#include <algorithm>

#include "core/kernels/parallel.h"
#include "core/kernels/variants.h"

namespace holdfast {
namespace {

constexpr int kLanes = RestCheck::kTile;

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
      const float h = history[i] * known[i], d = h - noisy[i] * known[i];
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

TileSums sums_of(const RestSignal& s, int x, int y) {
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
  const int end = std::min(y + RestCheck::kTile, s.guides.view.height);
  for (int line = y; line < end; ++line) {
    row.depth = s.guides.depth().row(line) + x;
    row.samples = s.history[s.channels].row(line) + x;
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

}  // namespace

RestCheck::RestCheck(int width, int height)
    : columns_((width + kTile - 1) / kTile),
      rows_((height + kTile - 1) / kTile),
      found_(static_cast<std::size_t>(columns_ * rows_)),
      tiles_(found_.size()),
      slow_(found_.size()) {}

void RestCheck::restart() { std::fill(tiles_.begin(), tiles_.end(), Tile{}); }

bool RestCheck::Tile::follow(const TileSums& sums, const LightChangeRule& rule) {
  if (!(sums.pixels > 1)) return false;
  double shift2 = 0;
  for (int c = 0; c < 3; ++c) {
    difference[c] += kSlowWeight * (sums.difference[c] / sums.pixels - difference[c]);
    shift2 += difference[c] * difference[c];
  }
  error2 =
      (1 - kSlowWeight) * (1 - kSlowWeight) * error2 + kSlowWeight * kSlowWeight * sums.error2();
  const double least = double{rule.least_share} * double{rule.least_share} * sums.level2();
  return shift2 > least && shift2 > kSlowDeviations * kSlowDeviations * error2;
}

RestFinding RestCheck::look(const RestSignal& signal, const LightChangeRule& rule) {
  for_each_index(0, rows_, 1, [&](int row) { look_at_row(row, signal, rule); });
  TileCounts counts;
  for (const TileFinding found : found_) counts.add(found);
  if (counts.changed > 0 || counts.everywhere(rule)) return RestFinding::kSudden;
  const bool slow = std::find(slow_.begin(), slow_.end(), 1) != slow_.end();
  return slow ? RestFinding::kSlow : RestFinding::kSame;
}

void RestCheck::look_at_row(int row, const RestSignal& signal, const LightChangeRule& rule) {
  for (int column = 0; column < columns_; ++column) {
    const auto tile = static_cast<std::size_t>(row * columns_ + column);
    const TileSums sums = sums_of(signal, column * kTile, row * kTile);
    found_[tile] = sums.verdict(rule);
    slow_[tile] = tiles_[tile].follow(sums, rule) ? 1 : 0;
  }
}

}  // namespace holdfast
