#pragma once

#include <cstdint>
#include <vector>

#include "core/frame/guides.h"
#include "core/history/tile_sums.h"

namespace holdfast {

/// Candidate values of a history, and their differences to the frame, as a blend has gathered them.
struct GatheredHistory {
  const Channels<float>& values;
  const Channels<float>& differences;  ///< value minus frame; 0 where there is no history
  int first = 0;                       ///< channel of the candidate in `values` and `differences`
  int channels = 1;
  int samples = 0;  ///< channel of `values`: 0 where there is no history
};

/// Where light has changed although nothing moved: a light was switched, or a cut went unannounced.
/// One pixel's neighbourhood cannot tell such a change from its noise, a tile can.
class LightChange {
 public:
  static constexpr int kTile = 16;  ///< pixels

  LightChange() = default;
  LightChange(int width, int height);

  /// Marks each tile that has changed, and those around it: with d the mean difference of a tile's
  /// n pixels with history, v the variance of one (both summed over channels), h the mean value:
  ///   |d|^2 > tile_deviations^2 v / n   and   |d| > least_share |h|
  /// Marks all tiles where more than frame_share of them, and more than three, differ by
  /// frame_deviations instead.
  ///   reads guides, gathered | halo 0
  void measure(const Guides& guides, const GatheredHistory& gathered, const LightChangeRule& rule);
  /// Nothing has changed.
  void clear();

  bool changed(int x, int y) const {
    return marked_[static_cast<std::size_t>(y / kTile * columns_ + x / kTile)] != 0;
  }
  /// How many of the `count` pixels from (x, y) on have all changed, or all not.
  int run(int x, int y, int count) const;
  /// Share of the tiles with history that have changed themselves, 0..1; 1 where all are marked.
  double share() const { return share_; }

 private:
  void measure_tiles(int row, const Guides& guides, const GatheredHistory& gathered,
                     const LightChangeRule& rule);
  void mark_around();

  int columns_ = 0, rows_ = 0;
  std::vector<TileFinding> found_;    ///< by tile
  std::vector<std::uint8_t> marked_;  ///< by tile: changed, or beside one that is
  double share_ = 0;
};

}  // namespace holdfast
