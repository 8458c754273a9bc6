#pragma once

#include <cstdint>
#include <vector>

#include "core/history/tile_sums.h"

namespace holdfast {

/// Where light has changed: a light was switched or dimmed, something appeared, or a cut went
/// unannounced. One pixel's neighbourhood cannot tell such a change from its noise; a tile can, or
/// a group of tiles, or the frame.
class LightChange {
 public:
  static constexpr int kTile = kTilePixels;
  static constexpr int kGroup = 4;  ///< tiles

  LightChange() = default;
  LightChange(int width, int height);

  /// Where nothing moves: marks each tile that has changed, and those around it: with d the mean
  /// difference of a tile's n pixels with history, v the variance of one (both summed over
  /// channels), h the mean value:
  ///   |d|^2 > tile_deviations^2 v / n   and   |d| > least_share |h|
  /// Marks all tiles where more than frame_share of them, and more than three, differ by
  /// frame_deviations instead. And estimates `bias`, of groups with
  /// tile_deviations.
  ///   reads signal | halo 0
  void measure(const TileSignal& signal, const LightChangeRule& rule);
  /// Where something moves: marks nothing, and estimates `bias`, of groups with moving_deviations.
  ///   reads signal | halo 0
  void measure_moving(const TileSignal& signal, const LightChangeRule& rule);
  /// Nothing has changed.
  void clear();

  bool changed(int x, int y) const {
    return marked_[static_cast<std::size_t>(y / kTile * columns_ + x / kTile)] != 0;
  }
  /// The squared bias that the history of a pixel is expected to have, in variances of its
  /// difference to the frame: the largest that the sums over its tile, its group of tiles and the
  /// frame show (TileSums::bias). Light and its noise grow together, so that what a bright place
  /// shows holds for a dark one. 0..TileSums::kMostBias.
  float bias(int x, int y) const {
    return bias_[static_cast<std::size_t>(y / kTile * columns_ + x / kTile)];
  }
  /// The same of `count` pixels from (x, y) on.
  void biases(int x, int y, int count, float* out) const;
  /// How many of the `count` pixels from (x, y) on have all changed, or all not.
  int run(int x, int y, int count) const;
  /// Share of the tiles with history that have changed themselves, 0..1; 1 where all are marked.
  double share() const { return share_; }

 private:
  void add_up(const TileSignal& signal);
  void add_up_row(int row, const TileSignal& signal);
  void estimate_bias(const LightChangeRule& rule, float group_deviations);
  void estimate_bias(int size, double deviations, double least_share);
  void mark_around();

  int columns_ = 0, rows_ = 0;
  std::vector<TileSums> sums_;        ///< by tile
  std::vector<float> bias_;           ///< by tile
  std::vector<TileFinding> found_;    ///< by tile
  std::vector<std::uint8_t> marked_;  ///< by tile: changed, or beside one that is
  double share_ = 0;
};

}  // namespace holdfast
