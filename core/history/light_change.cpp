#include "core/history/light_change.h"

#include <algorithm>

#include "core/kernels/parallel.h"

namespace holdfast {

LightChange::LightChange(int width, int height)
    : columns_((width + kTile - 1) / kTile),
      rows_((height + kTile - 1) / kTile),
      sums_(static_cast<std::size_t>(columns_ * rows_)),
      bias_(sums_.size()),
      found_(sums_.size()),
      marked_(found_.size()) {}

void LightChange::clear() {
  std::fill(marked_.begin(), marked_.end(), std::uint8_t{0});
  std::fill(bias_.begin(), bias_.end(), 0.0f);
  share_ = 0;
}

void LightChange::measure(const TileSignal& signal, const LightChangeRule& rule) {
  clear();
  add_up(signal);
  estimate_bias(rule, rule.tile_deviations);
  TileCounts counts;
  for (std::size_t tile = 0; tile < sums_.size(); ++tile) {
    found_[tile] = sums_[tile].verdict(rule);
    counts.add(found_[tile]);
  }
  if (counts.everywhere(rule)) {
    share_ = 1;
    std::fill(marked_.begin(), marked_.end(), std::uint8_t{1});
    return;
  }
  if (counts.changed > 0) {
    share_ = counts.changed / counts.known();
    mark_around();
  }
}

void LightChange::measure_moving(const TileSignal& signal, const LightChangeRule& rule) {
  clear();
  add_up(signal);
  estimate_bias(rule, rule.moving_deviations);
}

void LightChange::add_up(const TileSignal& signal) {
  for_each_index(0, rows_, 1, [&](int row) { add_up_row(row, signal); });
}

void LightChange::add_up_row(int row, const TileSignal& signal) {
  for_each_tile(signal, row, [&](int column, const TileSums& sums) {
    sums_[static_cast<std::size_t>(row * columns_ + column)] = sums;
  });
}

void LightChange::biases(int x, int y, int count, float* out) const {
  for (int i = 0; i < count;) {
    const int left = std::min(kTile - (x + i) % kTile, count - i);
    std::fill_n(out + i, left, bias(x + i, y));
    i += left;
  }
}

void LightChange::estimate_bias(const LightChangeRule& rule, float group_deviations) {
  const double least_share = double{rule.least_share};
  estimate_bias(1, double{rule.tile_deviations}, least_share);
  estimate_bias(kGroup, double{group_deviations}, least_share);
  estimate_bias(std::max(columns_, rows_), double{rule.frame_deviations}, least_share);
}

/// The same of squares of `size` tiles.
void LightChange::estimate_bias(int size, double deviations, double least_share) {
  for (int top = 0; top < rows_; top += size)
    for (int left = 0; left < columns_; left += size) {
      const int bottom = std::min(top + size, rows_), right = std::min(left + size, columns_);
      TileSums sums;
      for (int row = top; row < bottom; ++row)
        for (int column = left; column < right; ++column)
          sums.add(sums_[static_cast<std::size_t>(row * columns_ + column)]);
      const float bias = sums.bias(deviations, least_share);
      if (!(bias > 0.0f)) continue;
      for (int row = top; row < bottom; ++row)
        for (int column = left; column < right; ++column) {
          float& known = bias_[static_cast<std::size_t>(row * columns_ + column)];
          known = std::max(known, bias);
        }
    }
}

int LightChange::run(int x, int y, int count) const {
  const bool first = changed(x, y);
  int end = x / kTile * kTile + kTile;
  while (end < x + count && changed(end, y) == first) end += kTile;
  return std::min(end - x, count);
}

void LightChange::mark_around() {
  for (int row = 0; row < rows_; ++row)
    for (int column = 0; column < columns_; ++column) {
      if (found_[static_cast<std::size_t>(row * columns_ + column)] != TileFinding::kChanged)
        continue;
      for (int y = std::max(row - 1, 0); y <= std::min(row + 1, rows_ - 1); ++y)
        for (int x = std::max(column - 1, 0); x <= std::min(column + 1, columns_ - 1); ++x)
          marked_[static_cast<std::size_t>(y * columns_ + x)] = 1;
    }
}

}  // namespace holdfast
