#pragma once

#include "core/frame/plane.h"

namespace holdfast {

/// Fills the debug planes of `component` in `results`, of width x height pixels, from what a
/// temporal pass has recorded by DebugChannel: an image of that size, or of half of it.
void write_debug_planes(const Channels<float>& recorded, Component component, int width, int height,
                        PlaneSet& results);

}  // namespace holdfast
