#pragma once

#include <algorithm>
#include <cstdint>

#include "core/frame/guides.h"

namespace holdfast {

/// When a tile counts as changed. Ours; tuned on scenes at rest with and without a light switched.
struct LightChangeRule {
  bool noticed = false;            ///< look for changes at all
  float tile_deviations = 5.0f;    ///< of a tile's mean difference, in its standard errors
  float frame_deviations = 3.0f;   ///< the same of the frame's, and where many tiles differ by that
                                   ///< much:
  float frame_share = 1.0f;        ///< more of them than this, 0..1 (chance: 0.003); 1: never
  float moving_deviations = 5.0f;  ///< of the mean difference of a group of tiles where things move
  float least_share = 0.002f;      ///< of a tile's mean difference in its mean, below which it does
                                   ///< not show
};

/// What a tile's difference says of its light.
enum class TileFinding : std::uint8_t { kNoHistory, kSame, kSuspect, kChanged };

/// Sums over the pixels of a tile that have history: of a history h and its difference d to the
/// frame, by channel.
struct TileSums {
  double pixels = 0, square = 0;  ///< of |d|^2
  double difference[3] = {}, value[3] = {};

  static double square_of(double v) { return v * v; }
  /// |mean d|^2
  double shift2() const {
    double sum = 0;
    for (const double d : difference) sum += square_of(d / pixels);
    return sum;
  }
  /// |mean h|^2
  double level2() const {
    double sum = 0;
    for (const double h : value) sum += square_of(h / pixels);
    return sum;
  }
  void add(const TileSums& other) {
    pixels += other.pixels;
    square += other.square;
    for (int c = 0; c < 3; ++c) {
      difference[c] += other.difference[c];
      value[c] += other.value[c];
    }
  }
  /// Variance of mean d, summed over channels.
  double error2() const { return std::max(square / pixels - shift2(), 0.0) / pixels; }

  /// `known_error2`: what is known of error2 besides, at least.
  TileFinding verdict(const LightChangeRule& rule, double known_error2 = 0) const {
    if (!(pixels > 1)) return TileFinding::kNoHistory;
    const double shift = shift2(), error = std::max(error2(), known_error2);
    if (!(shift > square_of(double{rule.least_share}) * level2())) return TileFinding::kSame;
    if (shift > square_of(double{rule.tile_deviations}) * error) return TileFinding::kChanged;
    return shift > square_of(double{rule.frame_deviations}) * error ? TileFinding::kSuspect
                                                                    : TileFinding::kSame;
  }

  /// The squared bias of h that |mean d|^2 shows beyond `deviations` of its standard errors, which
  /// chance may make, in variances of one pixel's d and at most kMostBias; 0 unless it shows beside
  /// mean h.
  float bias(double deviations, double least_share) const {
    if (!(pixels > 1)) return 0.0f;
    const double shift = shift2(), error = error2();
    if (!(shift > square_of(least_share) * level2())) return 0.0f;
    const double shown = shift - square_of(deviations) * error;
    if (!(shown > 0)) return 0.0f;
    const double most = double{kMostBias} * error * pixels;
    return shown < most ? static_cast<float>(shown / (error * pixels)) : kMostBias;
  }
  static constexpr float kMostBias = 100.0f;  ///< nothing is left of a history by then
};

inline constexpr int kTilePixels = 16;  ///< width and height of a tile

/// A history and the frame that it is held against, all of one size.
struct TileSignal {
  const Guides& guides;
  ChannelView<const float> history[3], samples;  ///< without samples, a history may hold anything
  ChannelView<const float> noisy[3];             ///< finite
  int channels = 1;                              ///< 1 or 3
};

inline constexpr int kTilesAtOnce = 16;  ///< of a row: its lines are read as they lie in memory

/// Sums over `count` tiles, 1..kTilesAtOnce, from `column` on in a row of tiles.
void sum_tiles(const TileSignal& signal, int column, int row, int count, TileSums* sums);

/// Calls `use(column, sums)` for every tile of a row of tiles.
template <class Use>
void for_each_tile(const TileSignal& signal, int row, Use&& use) {
  const int columns = (signal.guides.view.width + kTilePixels - 1) / kTilePixels;
  for (int first = 0; first < columns; first += kTilesAtOnce) {
    const int count = std::min(kTilesAtOnce, columns - first);
    TileSums sums[kTilesAtOnce];
    sum_tiles(signal, first, row, count, sums);
    for (int i = 0; i < count; ++i) use(first + i, sums[i]);
  }
}

/// How many tiles of an image are found to be what.
struct TileCounts {
  double same = 0, suspect = 0, changed = 0;

  void add(TileFinding found) {
    same += found == TileFinding::kSame ? 1 : 0;
    suspect += found == TileFinding::kSuspect ? 1 : 0;
    changed += found == TileFinding::kChanged ? 1 : 0;
  }
  double known() const { return same + suspect + changed; }
  /// Whether so many differ that all have changed.
  bool everywhere(const LightChangeRule& rule) const {
    constexpr double kLeastTiles = 3;  // a few may differ by chance
    return suspect + changed > kLeastTiles + double{rule.frame_share} * known();
  }
};

}  // namespace holdfast
