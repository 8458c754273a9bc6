#pragma once

#include "client/measure/judged.h"
#include "core/frame/plane.h"
#include "core/history/taps.h"

namespace holdfast::measure {

/// The image of an earlier frame, brought to where a vector says that it is now.
struct Warped {
  Plane image;  ///< 0 where nothing was found
  Mask found;   ///< 1 where there were taps
};

/// Gathers `previous` at the history taps of each pixel, as the denoiser gathers its history. A
/// pixel without taps takes those of `fallback` (may be empty); without either it is not found.
/// All have the size of `previous`.
Warped warp(const Plane& previous, ChannelView<const Taps> taps,
            ChannelView<const Taps> fallback = {});

}  // namespace holdfast::measure
