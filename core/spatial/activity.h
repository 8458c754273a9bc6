#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/frame/guides.h"

namespace holdfast {

/// Which tiles of an image have anything to filter. A tile rests when the signals are constant over
/// the surfaces of its neighbourhood: a weighted mean there returns what it is given, so that
/// passes may copy it. Most of a frame is fully lit or fully in shadow.
///
/// The passes of a filter reach differently far; each has a zone of its own, a halo around what
/// varies.
class ActivityMap {
 public:
  static constexpr int kTileWidth = 16;    ///< pixels: a cache line of floats
  static constexpr int kTileHeight = 8;    ///< rows
  static constexpr int kWidestZone = 254;  ///< for `active`: any of the zones

  ActivityMap() = default;
  ActivityMap(int width, int height);

  /// Marks the tiles for filters of up to `halo` pixels: active where a signal's values on surfaces
  /// differ by more than `tolerance` times the largest of them within the tile and the tiles around
  /// it that the halo reaches.
  /// With `around_zero`, a tile whose signals are constant but not 0 is active, too.
  void measure(const Guides& guides, std::span<const ChannelView<const float>> signals, int halo,
               float tolerance, bool around_zero = false) {
    measure(guides, signals, {&halo, 1}, tolerance, around_zero);
  }

  /// The same for several zones: zone k is what is active for halos[k]. Halos do not fall.
  void measure(const Guides& guides, std::span<const ChannelView<const float>> signals,
               std::span<const int> halos, float tolerance, bool around_zero = false);

  /// Marks the tiles that come within `halo` pixels of a tile with a pixel, on a surface or not,
  /// whose value is below `limit`. Values are positive.
  void measure_below(ChannelView<const float> values, float limit, int halo);

  /// Whether the tile of pixel (x, y) is active in a zone.
  bool active(int x, int y, int zone = kWidestZone) const {
    return zone_[static_cast<std::size_t>(y / kTileHeight * columns_ + x / kTileWidth)] <= zone;
  }
  /// Share of tiles that are active in a zone, 0..1.
  double active_share(int zone = kWidestZone) const;

 private:
  static constexpr std::uint8_t kRest = 255;

  /// Of the pixels where `where` is positive.
  void measure_ranges(ChannelView<const float> where, ChannelView<const float> signal,
                      bool around_zero);
  void mark(int halo, int zone, float tolerance);
  std::size_t at(int row, int column) const {
    return static_cast<std::size_t>(row * columns_ + column);
  }

  int columns_ = 0, rows_ = 0;
  std::vector<std::uint8_t> zone_;  ///< the narrowest zone that a tile is active in, or kRest
  std::vector<float> low_, high_;   ///< of one signal, by tile
  std::vector<float> row_low_, row_high_;  ///< of the tiles of one row that a halo reaches
};

}  // namespace holdfast
