#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/frame/guides.h"

namespace holdfast {

/// Which tiles of an image have anything to filter. A tile rests when the signals are constant over
/// the surfaces of its neighbourhood: a weighted mean there returns what it is given, so that
/// passes may copy it. Most of a frame is fully lit or fully in shadow.
class ActivityMap {
 public:
  static constexpr int kTileWidth = 64;  ///< pixels
  static constexpr int kTileHeight = 8;  ///< rows

  ActivityMap() = default;
  ActivityMap(int width, int height);

  /// Marks the tiles for filters of up to `halo` pixels: active where a signal's values on surfaces
  /// differ by more than `tolerance` within the tile and the tiles around it that the halo reaches.
  /// With `around_zero`, a tile whose signals are constant but not 0 is active, too.
  void measure(const Guides& guides, std::span<const ChannelView<const float>> signals, int halo,
               float tolerance, bool around_zero = false);

  bool active(int x, int y) const {
    return active_[static_cast<std::size_t>(y / kTileHeight * columns_ + x / kTileWidth)] != 0;
  }
  /// Share of active tiles, 0..1.
  double active_share() const;

 private:
  int columns_ = 0, rows_ = 0;
  std::vector<std::uint8_t> active_;
  std::vector<float> low_, high_;  ///< of one signal, by tile
};

}  // namespace holdfast
