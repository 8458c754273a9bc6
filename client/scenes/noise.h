#pragma once

#include "client/scenes/rng.h"
#include "client/scenes/view.h"

namespace holdfast::scenes {

/// Streams of random numbers of a pixel of a noisy frame. Lights follow from kFirstLight on.
enum Stream : std::uint64_t { kGlossyStream, kIndirectStream, kFirstLight };

/// The random numbers of one component at pixel (x, y).
inline Rng noise_of(const View& view, int x, int y, std::uint64_t stream) {
  const auto pixel = static_cast<std::uint64_t>(y) * static_cast<std::uint64_t>(view.width) +
                     static_cast<std::uint64_t>(x);
  return {view.seed, static_cast<std::uint64_t>(view.frame), pixel, stream};
}

}  // namespace holdfast::scenes
