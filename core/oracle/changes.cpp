#include "core/oracle/changes.h"

#include <algorithm>
#include <utility>

namespace holdfast::oracle {
namespace {

enum class Found { kNothing, kSame, kSuspect, kChanged };

/// Of the pixels of a square that have history: their number n, |mean difference|^2, its variance,
/// and |mean value|^2, summed over channels.
struct Square {
  double n = 0, shift2 = 0, error2 = 0, level2 = 0;

  Square(const Surfaces& now, const Image& values, const Image& differences, const Image& samples,
         int left, int top, int size) {
    double squares = 0, difference[3] = {}, value[3] = {};
    for (int y = top; y < std::min(top + size, now.height); ++y)
      for (int x = left; x < std::min(left + size, now.width); ++x) {
        if (!now.any(x, y) || !(samples.at(x, y) > 0)) continue;
        n += 1;
        for (int c = 0; c < values.channels(); ++c) {
          difference[c] += differences.at(x, y, c);
          value[c] += values.at(x, y, c);
          squares += square(differences.at(x, y, c));
        }
      }
    if (!(n > 1)) return;
    for (int c = 0; c < 3; ++c) {
      shift2 += square(difference[c] / n);
      level2 += square(value[c] / n);
    }
    error2 = std::max(squares / n - shift2, 0.0) / n;
  }
  bool differs(const LightChangeRule& rule, float deviations) const {
    return n > 1 && shift2 > square(double{rule.least_share}) * level2 &&
           shift2 > square(double{deviations}) * error2;
  }
};

Found verdict_of(const Square& tile, const LightChangeRule& rule) {
  if (!(tile.n > 1)) return Found::kNothing;
  if (tile.differs(rule, rule.tile_deviations)) return Found::kChanged;
  return tile.differs(rule, rule.frame_deviations) ? Found::kSuspect : Found::kSame;
}

}  // namespace

Changes::Changes(int width, int height)
    : columns_((width + kTile - 1) / kTile),
      rows_((height + kTile - 1) / kTile),
      marked_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_)),
      bias_(width, height, 1) {}

Changes::Changes(const Surfaces& now, const Image& values, const Image& differences,
                 const Image& samples, const LightChangeRule& rule, bool moving)
    : Changes(now.width, now.height) {
  const float of_group = moving ? rule.moving_deviations : rule.tile_deviations;
  for (const auto& [size, deviations] : {std::pair(kTile, rule.tile_deviations),
                                         {kTile * LightChange::kGroup, of_group},
                                         {std::max(now.width, now.height), rule.frame_deviations}})
    for (int top = 0; top < now.height; top += size)
      for (int left = 0; left < now.width; left += size) {
        const Square sums(now, values, differences, samples, left, top, size);
        if (!sums.differs(rule, deviations)) continue;
        // n error^2 is the variance of one difference.
        const double chance = square(double{deviations}) * sums.error2;
        const double shown = (sums.shift2 - chance) / std::max(sums.n * sums.error2, 1e-300);
        for (int y = top; y < std::min(top + size, now.height); ++y)
          for (int x = left; x < std::min(left + size, now.width); ++x)
            bias_.at(x, y) = std::max(bias_.at(x, y), std::min(shown, double{TileSums::kMostBias}));
      }
  if (!moving) mark(now, values, differences, samples, rule);
}

void Changes::mark(const Surfaces& now, const Image& values, const Image& differences,
                   const Image& samples, const LightChangeRule& rule) {
  constexpr double kLeastTiles = 3;  // a few may differ by chance
  double changed = 0, suspect = 0, known = 0;
  for (int row = 0; row < rows_; ++row)
    for (int column = 0; column < columns_; ++column) {
      const Square tile(now, values, differences, samples, column * kTile, row * kTile, kTile);
      const Found found = verdict_of(tile, rule);
      known += found != Found::kNothing ? 1 : 0;
      suspect += found == Found::kSuspect || found == Found::kChanged ? 1 : 0;
      if (found != Found::kChanged) continue;
      changed += 1;
      for (int y = std::max(row - 1, 0); y <= std::min(row + 1, rows_ - 1); ++y)
        for (int x = std::max(column - 1, 0); x <= std::min(column + 1, columns_ - 1); ++x)
          marked_[index(x, y)] = true;
    }
  share_ = known > 0 ? changed / known : 0;
  if (suspect > kLeastTiles + double{rule.frame_share} * known) {
    share_ = 1;
    marked_.assign(marked_.size(), true);
  }
}

}  // namespace holdfast::oracle
