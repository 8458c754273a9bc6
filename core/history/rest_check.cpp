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

void RestCheck::restart() {
  std::fill(tiles_.begin(), tiles_.end(), Tile{});
  frames_ = 0;
}

TileFinding RestCheck::Tile::look(const TileSums& sums, const LightChangeRule& rule,
                                  double usual_weight) {
  const TileFinding found = sums.verdict(rule, usual2);
  if (found == TileFinding::kNoHistory) return found;
  const double error2 = std::max(sums.error2(), usual2);
  for (int c = 0; c < 3; ++c)
    lasting[c] += kWeight * (sums.difference[c] / sums.pixels - lasting[c]);
  lasting_error2 = (1 - kWeight) * (1 - kWeight) * lasting_error2 + kWeight * kWeight * error2;
  usual2 += usual_weight * (sums.shift2() - usual2);
  return found;
}

bool RestCheck::Tile::changes_slowly(const TileSums& sums, const LightChangeRule& rule) const {
  if (!(sums.pixels > 1)) return false;
  double shift2 = 0;
  for (const double d : lasting) shift2 += d * d;
  const double least = double{rule.least_share} * double{rule.least_share} * sums.level2();
  return shift2 > least && shift2 > kSlowDeviations * kSlowDeviations * lasting_error2;
}

RestFinding RestCheck::look(const RestSignal& signal, const LightChangeRule& rule) {
  frames_ = std::min(frames_ + 1, static_cast<int>(1 / kUsualWeight));
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
    found_[tile] = tiles_[tile].look(sums, rule, 1.0 / frames_);
    slow_[tile] = tiles_[tile].changes_slowly(sums, rule) ? 1 : 0;
  }
}

}  // namespace holdfast
