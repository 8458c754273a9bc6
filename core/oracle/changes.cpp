#include "core/oracle/changes.h"

#include <algorithm>

namespace holdfast::oracle {
namespace {

enum class Found { kNothing, kSame, kSuspect, kChanged };

/// With d the mean difference of the tile's n pixels with history, v the variance of one (both
/// summed over channels) and h the mean value: |d|^2 against deviations^2 v / n.
Found verdict_of(const Surfaces& now, const Image& values, const Image& differences,
                 const Image& samples, const LightChangeRule& rule, int left, int top, int size) {
  double n = 0, squares = 0, difference[3] = {}, value[3] = {};
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
  if (!(n > 1)) return Found::kNothing;
  double shift2 = 0, level2 = 0;
  for (int c = 0; c < 3; ++c) {
    shift2 += square(difference[c] / n);
    level2 += square(value[c] / n);
  }
  const double error2 = std::max(squares / n - shift2, 0.0) / n;
  if (!(shift2 > square(double{rule.least_share}) * level2)) return Found::kSame;
  if (shift2 > square(double{rule.tile_deviations}) * error2) return Found::kChanged;
  return shift2 > square(double{rule.frame_deviations}) * error2 ? Found::kSuspect : Found::kSame;
}

}  // namespace

Changes::Changes(int width, int height)
    : columns_((width + kTile - 1) / kTile),
      rows_((height + kTile - 1) / kTile),
      marked_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_)) {}

Changes::Changes(const Surfaces& now, const Image& values, const Image& differences,
                 const Image& samples, const LightChangeRule& rule)
    : Changes(now.width, now.height) {
  constexpr double kLeastTiles = 3;  // a few may differ by chance
  double changed = 0, suspect = 0, known = 0;
  for (int row = 0; row < rows_; ++row)
    for (int column = 0; column < columns_; ++column) {
      const Found found =
          verdict_of(now, values, differences, samples, rule, column * kTile, row * kTile, kTile);
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
