#include "core/history/light_change.h"

#include <algorithm>

#include "core/kernels/math.h"
#include "core/kernels/parallel.h"

namespace holdfast {
namespace {

enum Found : std::uint8_t { kNoHistory, kSame, kSuspect, kChanged };

/// Sums over the pixels of a tile that have history.
struct TileSums {
  double pixels = 0, square = 0;
  double difference[3] = {}, value[3] = {};

  Found verdict(const LightChangeRule& rule) const {
    if (!(pixels > 1)) return kNoHistory;
    double shift2 = 0, level2 = 0;
    for (int c = 0; c < 3; ++c) {
      shift2 += square_of(difference[c] / pixels);
      level2 += square_of(value[c] / pixels);
    }
    const double variance = std::max(square / pixels - shift2, 0.0);
    const double error2 = variance / pixels;
    if (!(shift2 > square_of(double{rule.least_share}) * level2)) return kSame;
    if (shift2 > square_of(double{rule.tile_deviations}) * error2) return kChanged;
    return shift2 > square_of(double{rule.frame_deviations}) * error2 ? kSuspect : kSame;
  }
  static double square_of(double v) { return v * v; }
};

}  // namespace

LightChange::LightChange(int width, int height)
    : columns_((width + kTile - 1) / kTile),
      rows_((height + kTile - 1) / kTile),
      found_(static_cast<std::size_t>(columns_ * rows_)),
      marked_(found_.size()) {}

void LightChange::clear() {
  std::fill(marked_.begin(), marked_.end(), std::uint8_t{0});
  share_ = 0;
}

void LightChange::measure(const Guides& guides, const GatheredHistory& gathered,
                          const LightChangeRule& rule) {
  for_each_row(rows_, [&](int row) { measure_tiles(row, guides, gathered, rule); });
  const auto count = [&](Found what) { return std::count(found_.begin(), found_.end(), what); };
  constexpr double kLeastTiles = 3;  // a few may differ by chance
  const auto changed = static_cast<double>(count(kChanged));
  const double suspect = changed + static_cast<double>(count(kSuspect));
  const double known = suspect + static_cast<double>(count(kSame));
  clear();
  if (suspect > kLeastTiles + double{rule.frame_share} * known) {
    share_ = 1;
    std::fill(marked_.begin(), marked_.end(), std::uint8_t{1});
    return;
  }
  if (changed > 0) {
    share_ = changed / known;
    mark_around();
  }
}

void LightChange::measure_tiles(int row, const Guides& guides, const GatheredHistory& gathered,
                                const LightChangeRule& rule) {
  const int y_end = std::min((row + 1) * kTile, guides.view.height);
  for (int column = 0; column < columns_; ++column) {
    TileSums sums;
    const int x_end = std::min((column + 1) * kTile, guides.view.width);
    for (int y = row * kTile; y < y_end; ++y) {
      const float* depth = guides.depth().row(y);
      const float* samples = gathered.values[gathered.samples].row(y);
      for (int c = 0; c < gathered.channels; ++c) {
        const float* value = gathered.values[gathered.first + c].row(y);
        const float* difference = gathered.differences[gathered.first + c].row(y);
        for (int x = column * kTile; x < x_end; ++x) {
          if (!(depth[x] > 0.0f) || !(samples[x] > 0.0f)) continue;
          sums.pixels += c == 0 ? 1 : 0;
          sums.square += static_cast<double>(difference[x]) * static_cast<double>(difference[x]);
          sums.difference[c] += static_cast<double>(difference[x]);
          sums.value[c] += static_cast<double>(value[x]);
        }
      }
    }
    found_[static_cast<std::size_t>(row * columns_ + column)] = sums.verdict(rule);
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
      if (found_[static_cast<std::size_t>(row * columns_ + column)] != kChanged) continue;
      for (int y = std::max(row - 1, 0); y <= std::min(row + 1, rows_ - 1); ++y)
        for (int x = std::max(column - 1, 0); x <= std::min(column + 1, columns_ - 1); ++x)
          marked_[static_cast<std::size_t>(y * columns_ + x)] = 1;
    }
}

}  // namespace holdfast
