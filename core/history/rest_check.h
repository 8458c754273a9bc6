#pragma once

#include <vector>

#include "core/frame/guides.h"
#include "core/history/tile_sums.h"

namespace holdfast {

/// A component's history at rest and the frame that it is held against, all of one size.
struct RestSignal {
  const Guides& guides;
  const Channels<float>& history;  ///< values, then in channel `channels` their samples
  const Channels<float>& noisy;    ///< finite
  int channels = 1;                ///< 1 or 3
};

/// What a look at a frame of a component at rest has found.
enum class RestFinding {
  kSame,
  kSudden,  ///< this frame differs: LightChangeRule
  kSlow,    ///< frames differ, each by little: light changes by little a frame
};

/// Whether light still is what a history at rest says, by tiles, without touching a history.
/// Sudden changes are found as LightChange finds them, but for the standard error e of a tile's
/// mean difference d: it is no less than the root mean square of the d before, since a
/// frame without a rare bright sample does not know that there are any. A slow change hides in the
/// noise of any one frame; its lasting difference does not: D <- (1 - w) D + w d and E^2 <- (1 -
/// w)^2 E^2 + w^2 e^2 with w = kWeight, and the tile has changed where |D| > kSlowDeviations E and
/// |D| is no less than the rule's least share of the mean.
class RestCheck {
 public:
  static constexpr int kTile = kTilePixels;
  /// Of a frame in the lasting difference. Ours.
  static constexpr double kWeight = 1.0 / 16;
  /// Of a frame in the mean |d|^2, at least. Ours: a slow change is found before it is usual.
  static constexpr double kUsualWeight = 1.0 / 128;
  /// Ours: so that chance finds none in the 8000 tiles of a large frame over hours.
  static constexpr double kSlowDeviations = 6;

  RestCheck() = default;
  RestCheck(int width, int height);

  /// Forgets all frames.
  void restart();
  ///   reads guides, history, noisy | halo 0
  RestFinding look(const RestSignal& signal, const LightChangeRule& rule);

 private:
  struct Tile {
    double lasting[3] = {}, lasting_error2 = 0;  ///< D, E^2
    double usual2 = 0;                           ///< mean |d|^2
    TileFinding look(const TileSums& sums, const LightChangeRule& rule, double usual_weight);
    bool changes_slowly(const TileSums& sums, const LightChangeRule& rule) const;
  };
  void look_at_row(int row, const RestSignal& signal, const LightChangeRule& rule);

  int columns_ = 0, rows_ = 0;
  int frames_ = 0;                  ///< since the last restart
  std::vector<TileFinding> found_;  ///< by tile
  std::vector<Tile> tiles_;
  std::vector<std::uint8_t> slow_;  ///< by tile: changed slowly
};

}  // namespace holdfast
