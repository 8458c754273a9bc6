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
  kSlow,    ///< the frames since the rest began differ: light changes by little a frame
};

/// Whether light still is what a history at rest says, by tiles, without touching a history.
/// Sudden changes are found as LightChange finds them. A slow one hides in the noise of any one
/// frame; its lasting difference does not: with d the mean difference of a tile in a frame and e
/// its standard error, D <- (1 - w) D + w d and E^2 <- (1 - w)^2 E^2 + w^2 e^2 with
/// w = kSlowWeight, and the tile has changed where |D| > kSlowDeviations E and |D| is no less than
/// the rule's least share of the mean.
class RestCheck {
 public:
  static constexpr int kTile = 16;  ///< pixels
  /// Ours: long enough to find a change that a history of 64 frames would lag behind by its noise.
  static constexpr double kSlowWeight = 1.0 / 16;
  /// Ours: so that chance finds none in the 8000 tiles of a large frame over hours.
  static constexpr double kSlowDeviations = 6;

  RestCheck() = default;
  RestCheck(int width, int height);

  /// Forgets lasting differences: a rest begins.
  void restart();
  ///   reads guides, history, noisy | halo 0
  RestFinding look(const RestSignal& signal, const LightChangeRule& rule);

 private:
  struct Tile {
    double difference[3] = {}, error2 = 0;
    bool follow(const TileSums& sums, const LightChangeRule& rule);
  };
  void look_at_row(int row, const RestSignal& signal, const LightChangeRule& rule);

  int columns_ = 0, rows_ = 0;
  std::vector<TileFinding> found_;  ///< by tile
  std::vector<Tile> tiles_;         ///< lasting differences
  std::vector<std::uint8_t> slow_;  ///< by tile: changed slowly
};

}  // namespace holdfast
