#pragma once

#include "core/history/shadow_history.h"
#include "core/history/surface_history.h"

namespace holdfast {

/// What is kept of one component between frames, per pixel: the accumulated signal, the number of
/// equal samples behind it, and, where the recipe asks for them, the first two moments of its
/// luminance.
struct ComponentHistory {
  Channels<float> data;
  int channels = 1;  ///< of the signal: 1 or 3

  ComponentHistory() = default;
  ComponentHistory(int width, int height, int signal_channels, bool with_moments)
      : data(width, height, signal_channels + (with_moments ? 3 : 1)), channels(signal_channels) {}

  ChannelView<const float> samples() const { return data[channels]; }
  ChannelView<float> samples() { return data[channels]; }
  bool has_moments() const { return data.count() > channels + 1; }
  ChannelView<const float> moment(int order) const { return data[channels + order]; }
  ChannelView<float> moment(int order) { return data[channels + order]; }
};

/// The histories that a component may follow, and how fast to leave them. Null: none of that kind.
struct HistorySources {
  const SurfaceHistory* surface = nullptr;
  const ShadowHistory* shadow = nullptr;
  ChannelView<const float> antilag = {};  ///< lambda of `antilag_of_gradients`, by stratum
};

/// Optional record of what a temporal pass did, for the debug planes: motion_px X, Y, frames of
/// history used, confidence (the weight of history, 0..1).
enum DebugChannel { kDebugX, kDebugY, kDebugFrames, kDebugTrust, kDebugChannels };

}  // namespace holdfast
