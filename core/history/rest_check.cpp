#include "core/history/rest_check.h"

#include <algorithm>

#include "core/kernels/parallel.h"

namespace holdfast {
namespace {

TileSignal signal_of(const RestSignal& s) {
  TileSignal signal{s.guides, {}, s.history[s.channels], {}, s.channels};
  for (int c = 0; c < s.channels; ++c) {
    signal.history[c] = s.history[c];
    signal.noisy[c] = s.noisy[c];
  }
  return signal;
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
  for_each_tile(signal_of(signal), row, [&](int column, const TileSums& sums) {
    const auto tile = static_cast<std::size_t>(row * columns_ + column);
    found_[tile] = tiles_[tile].look(sums, rule, 1.0 / frames_);
    slow_[tile] = tiles_[tile].changes_slowly(sums, rule) ? 1 : 0;
  });
}

}  // namespace holdfast
