#pragma once

#include "core/history/component_history.h"

namespace holdfast {

/// What a session keeps of its last frame, brought to another image size: the frame looks as if it
/// had been rendered at that size, with the same camera.

/// Fills `now`, whose view and rays are set and show the camera of `before`, at another size. A
/// pixel takes normal, id and roughness of the pixel of `before` in which its centre lies, and the
/// depth at which its own ray meets that pixel's tangent plane (that pixel's depth, where the two
/// differ by more than a quarter). Motion vectors are scaled.
///   reads guides | writes guides | halo 1 px
void resample_guides(const Guides& before, Guides& now);

/// Fills `to`, of the size of `now`, from `from`, of the size of `before`: each pixel of a surface
/// takes the mean of the pixels around its place that show the same surface (find_taps), in the
/// same way for signal and samples. Of these `share` (above 0 .. 1) counts: at a larger size
/// history is a blur of what it is to show, and a recipe that trusted it wholly would keep that
/// (36.8 dB after 160x90 to 480x270 on fence; a fresh start 38.7). Sizes that are the same are
/// copied. What recipes keep besides comes along if both histories have it; else moments start at
/// those of the signal, with so few samples (3) that SVGF estimates the variance in space until it
/// has its own.
///   reads guides of both sizes, `from` | writes `to` | halo 1 px
void resample_history(const Guides& before, const Guides& now, float share,
                      const ComponentHistory& from, ComponentHistory& to);

}  // namespace holdfast
