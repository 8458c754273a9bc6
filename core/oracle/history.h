#pragma once

#include "core/oracle/taps.h"

namespace holdfast::oracle {

/// What is kept of one component between frames.
struct History {
  Image signal;   ///< 1 or 3 channels
  Image samples;  ///< number of equal samples behind each pixel
  Image moments;  ///< the first two moments of the luminance; only for the svgf filter
};

/// What a blend did, besides the history that it leaves.
struct Blended {
  History now;
  Image motion;          ///< motion_px X, Y that was followed
  Image frames, weight;  ///< samples of the history that was used, and its weight 0..1
  double changed_share = 0;

  Blended(int width, int height, int channels)
      : motion(width, height, 2), frames(width, height, 1), weight(width, height, 1) {
    now.signal = Image(width, height, channels);
    now.samples = Image(width, height, 1);
  }
  void record(int x, int y, const Past& followed, double samples, double history_weight) {
    for (int axis = 0; axis < 2; ++axis) motion.at(x, y, axis) = followed.motion.at(x, y, axis);
    frames.at(x, y) = samples;
    weight.at(x, y) = history_weight;
  }
};

/// The histories that a component may follow; null: none of that kind.
struct Sources {
  const Past* surface = nullptr;
  const Past* effect = nullptr;
  const Image* antilag = nullptr;  ///< lambda of gradient samples, by stratum of 3x3 pixels
};

}  // namespace holdfast::oracle
