#pragma once

#include "core/spatial/guided_filter.h"
#include "core/spatial/tap_weights.h"

namespace holdfast {

/// Scratch of windows.
struct WindowScratch {
  static constexpr int kMostChannels = 7;
  Channels<float> between;  ///< kMostChannels, after the first pass
  Channels<float> spread;   ///< 2: after the first pass, result
  Channels<float> ones;     ///< one row, its own
  TapWeights weights;       ///< of the frame; to be cleared before each

  WindowScratch() = default;
  WindowScratch(int width, int height, Memory memory = Memory::kOwned);
  static void each_image(auto& s, auto&& visit) {
    visit(s.between);
    visit(s.spread);
    TapWeights::each_image(s.weights, visit);
  }
  /// An image of ones: every row is the same one.
  ChannelView<const float> all_ones() const {
    return {ones[0].data, spread.width(), spread.height(), 0};
  }
};

/// Means of the first `count` channels of `in` into those of `out`, over a window that stays on the
/// pixel's surface: two passes of 3x3 equal taps, the second at `second_step`, so that the window
/// is 3 + 2 * second_step pixels wide. Step 3 tiles 9x9 pixels exactly; step 2 overlaps to 7x7 with
/// larger weights inside. Tiles that `activity` lists at rest copy their input. 1, 2 or 7 channels.
///   reads guides, `in` | writes `out` | halo 1 + second_step px
void window_means(const Guides& guides, const Channels<float>& in, int count, int second_step,
                  WindowScratch& scratch, Channels<float>& out,
                  const ActivityMap* activity = nullptr);

/// The same of 2 or 4 channels into those from `first_out` on, with the number n of equal samples
/// in each window's mean (exact for step 3): returns the channel of 1/n, which is 1 in tiles at
/// rest. With a `footprint` (E, F, G of FilterPass), of `precision` times its precision,
/// taps outside it count less.
ChannelView<const float> counted_window_means(const Guides& guides, const Channels<float>& in,
                                              int count, int second_step, WindowScratch& scratch,
                                              Channels<float>& out, int first_out = 0,
                                              const ActivityMap* activity = nullptr,
                                              const Channels<float>* footprint = nullptr,
                                              float precision = 1.0f);

}  // namespace holdfast
