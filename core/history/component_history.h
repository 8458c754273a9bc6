#pragma once

#include "core/history/effect_history.h"
#include "core/history/kept_images.h"
#include "core/history/surface_history.h"

namespace holdfast {

/// What a component keeps besides its signal and samples.
enum class HistoryExtras {
  kNone,
  kMoments,  ///< the first two moments of the luminance
};

/// What one frame leaves of a component for the next, per pixel: the accumulated signal, the number
/// of equal samples behind it, and what the recipe asks for besides.
struct ComponentHistory {
  Channels<float> data;
  int channels = 1;  ///< of the signal: 1 or 3
  HistoryExtras extras = HistoryExtras::kNone;

  ComponentHistory() = default;
  ComponentHistory(int width, int height, int signal_channels, HistoryExtras with,
                   Memory memory = Memory::kOwned)
      : data(width, height, channel_count(signal_channels, with), memory),
        channels(signal_channels),
        extras(with) {}

  /// The same without images.
  ComponentHistory(int signal_channels, HistoryExtras with)
      : channels(signal_channels), extras(with) {}
  std::size_t bytes() const { return data.bytes(); }
  /// How its channels are kept when packed: the signal in halves, statistics in bytes.
  std::vector<KeptAs> kept_as() const {
    std::vector<KeptAs> as(static_cast<std::size_t>(channels), KeptAs::kHalf);
    as.push_back(KeptAs::kFineByte);
    if (has_moments()) as.insert(as.end(), {KeptAs::kHalf, KeptAs::kHalf});
    return as;
  }
  static int channel_count(int channels, HistoryExtras extras) {
    return channels + 1 + (extras == HistoryExtras::kMoments ? 2 : 0);
  }

  ChannelView<const float> samples() const { return data[channels]; }
  ChannelView<float> samples() { return data[channels]; }
  bool has_moments() const { return extras == HistoryExtras::kMoments; }
  ChannelView<const float> moment(int order) const { return data[channels + order]; }
  ChannelView<float> moment(int order) { return data[channels + order]; }
};

/// The histories that a component may follow: its surface's, and that of the effect itself (shadow,
/// reflection, disocclusion); and how fast to leave them. Null: none of that kind.
struct HistorySources {
  const SurfaceHistory* surface = nullptr;
  const EffectHistory* effect = nullptr;
  ChannelView<const float> antilag = {};  ///< lambda of `antilag_of_gradients`, by stratum
  bool effect_stands_in = false;  ///< the effect is followed only where the surface has no taps,
                                  ///< and is anything elsewhere
};

/// Optional record of what a temporal pass did, for the debug planes: motion_px X, Y, frames of
/// history used, confidence (the weight of history, 0..1).
enum DebugChannel { kDebugX, kDebugY, kDebugFrames, kDebugTrust, kDebugChannels };

}  // namespace holdfast
